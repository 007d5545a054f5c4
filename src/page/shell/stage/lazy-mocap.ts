import type { Object3D } from 'three';
import { type AvatarPose, estimatorNames, firstLine, reasonOf, recordOf, type TrackingFrame } from 'threepoint/core';
import { palettes, weaveCloth } from 'threepoint/internal/three';
import type { Avatar } from 'threepoint/three';
import { pageElement } from 'threepoint-ui';
import type { MocapView, Span } from '../../mocap/mocap-view';
import type { ClipView } from '../../mocap/motion-bones';
import { home } from '../activity-registry';
import { estimatorTexts } from '../session/estimator-texts';
import type { Activities } from './activities';
import { buildBuiltIn } from './avatar-loader';
import type { BoneMapStore } from './bone-map-store';
import type { DrawingParts } from './drawing-parts';

const labels = recordOf(estimatorNames, (name) => estimatorTexts[name].label);

/** The span of the page's body alone. */
const noSpan: Span = { from: 0, to: 0 };

/** Loads the motion capture viewer with the first file. It belongs to the mirror: files that are opened lead there. */
export class LazyMocap {
  readonly #parts: DrawingParts;
  readonly #activities: Pick<Activities, 'current' | 'goTo'>;
  readonly #boneMaps: BoneMapStore;
  readonly #prepare: (object: Object3D) => Promise<void>;
  #view: MocapView | null = null;

  /** `prepare`: compiles the materials of an object and uploads its textures before it is shown. */
  constructor(
    parts: DrawingParts & { readonly activities: Pick<Activities, 'current' | 'goTo'> },
    boneMaps: BoneMapStore,
    prepare: (object: Object3D) => Promise<void>,
  ) {
    this.#parts = parts;
    this.#activities = parts.activities;
    this.#boneMaps = boneMaps;
    this.#prepare = prepare;
  }

  /**
   * Shows the motion of files of this device or of addresses. Never rejects: faults become notices. `requestNumber`:
   * its number among the recorder's requests.
   */
  async open(
    sources: readonly (File | string)[],
    view: ClipView = {},
    requestNumber = this.#parts.recorder.nextRequest(),
  ): Promise<void> {
    // A study decides where its participant is.
    if (!this.#parts.study.run) await this.#activities.goTo(home);
    try {
      const { MocapView } = await import('../../mocap/mocap-view');
      this.#view ??= this.#build(MocapView);
    } catch (error) {
      const reason = firstLine(reasonOf(error));
      this.#parts.notices.show('error', `The motion capture viewer could not be loaded: ${reason}`);
    }
    await this.#view?.open(sources, view, requestNumber);
  }

  /** The places of the leftmost and the rightmost of the shown bodies, to the right of the page's body [m]. */
  get span(): Span {
    return this.#view?.span ?? noSpan;
  }

  frame(frame: TrackingFrame, pose: AvatarPose): void {
    this.#view?.frame(frame, pose);
  }

  /** Updates the card; called several times a second. In a game it is hidden. */
  show(): void {
    this.#view?.setVisible(this.#activities.current === null);
    this.#view?.show();
  }

  #build(View: typeof MocapView): MocapView {
    const { body, recorder, store, stage, onChange } = this.#parts;
    return new View({
      ...this.#parts,
      scene: stage.studio.scene,
      boneMaps: this.#boneMaps,
      prepare: this.#prepare,
      labels,
      region: pageElement('play', HTMLElement),
      replay: recorder,
      method: {
        get selected() {
          return body.selectedEstimator;
        },
        select(estimator) {
          store.remember({ estimator });
          void body.setEstimator(estimator);
          onChange();
        },
      },
      loadAvatar: () => this.#loadAvatar(),
      onJump() {
        body.discontinuity();
        onChange();
      },
    });
  }

  /** Loads a built-in avatar in other colours than those of the first. */
  async #loadAvatar(): Promise<Avatar> {
    const { quality, settings } = this.#parts;
    const { builtInBody, palette } = settings;
    const avatar = await buildBuiltIn(builtInBody);
    avatar.setClothWeave(quality === 'high' ? weaveCloth : null);
    avatar.setPalette(palettes.find(({ name }) => name !== palette)!.name);
    await this.#prepare(avatar.object);
    return avatar;
  }
}
