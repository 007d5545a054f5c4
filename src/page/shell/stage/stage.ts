import type { TrackingFrame } from 'threepoint/core';
import { defaultSavings, type Savings } from 'threepoint/internal';
import { createDebugSkeleton, createHeadLossFade } from 'threepoint/internal/three';
import type { Side } from 'threepoint/math';
import type { Avatar } from 'threepoint/three';
import { createVrCaptions } from 'threepoint-ui/vr';
import type { Watched } from '../../activity/activity';
import { DesktopView, type Insets } from '../../scene/desktop-view';
import { createHeadsetCamera, createRenderer, fitToWindow, type Quality } from '../../scene/renderer';
import { createVignette } from '../../scene/vignette';
import { Mirrors } from '../../studio/mirrors';
import { createStudio, type Studio } from '../../studio/studio';

/** The position of the shadow and the light of an absent body [m]. */
const outOfSight = 100;
/** Longest step of a camera that follows [s]: a page that was asleep does not leap. */
const longestStep = 0.1;
/** The height of the pelvis as a share of the eye height, without a body. */
const pelvisShare = 0.58;

/** The content of one picture: avatar, viewer and mirror. */
export interface Picture {
  readonly time: number;
  /** null: the head is not seen. */
  readonly frame: TrackingFrame | null;
  readonly avatar: Avatar | null;
  readonly inSession: boolean;
  /** How far to the right of its user the body of a session is drawn [m]; 0: where the user is. */
  readonly beside: number;
  /** The places of the leftmost and the rightmost of the bodies that are looked at, to the right of the body [m]. */
  readonly span: { readonly from: number; readonly to: number };
  /** The person that a camera without a body of its own looks at; null: there is a body. */
  readonly watched: Watched | null;
  /**
   * never; always; or only for a camera that does not stand behind the mirror: from there one wants to see the body.
   */
  readonly mirror: 'never' | 'always' | 'unless-behind';
  /** What the picture of a session gives up so that its frames are in time. */
  readonly savings: Savings;
}

/** The renderer with its studio, mirror and cameras. */
export class Stage {
  readonly renderer: ReturnType<typeof createRenderer>;
  readonly studio: Studio;
  readonly view: DesktopView;
  readonly vignette = createVignette();
  /** The newest picture: its reflections in the mirror, and the rest with all eyes and shadows. */
  readonly drawn = { mirror: { drawCalls: 0, triangles: 0 }, scene: { drawCalls: 0, triangles: 0 } };
  readonly #quality: Quality;
  readonly #mirrors: Mirrors;
  readonly #skeleton = createDebugSkeleton();
  readonly #headLoss = createHeadLossFade();
  readonly #headsetCamera = createHeadsetCamera();
  readonly #captions = createVrCaptions();
  #lastTime = 0;
  #savings = defaultSavings;

  constructor(canvas: HTMLCanvasElement, quality: Quality) {
    this.#quality = quality;
    this.renderer = createRenderer(canvas, quality);
    this.studio = createStudio(this.renderer, quality);
    this.view = new DesktopView(canvas);
    this.#mirrors = new Mirrors(quality);
    const parts = [this.#mirrors, this.#skeleton, this.vignette, this.#captions];
    this.studio.scene.add(...parts.map(({ object }) => object));
    // A picture has several renders, and three.js would restart its counts in each of them.
    this.renderer.info.autoReset = false;
  }

  get savings(): Savings {
    return this.#savings;
  }

  /** Shows a line low before the eyes of a session; empty: none. */
  caption(text: string): void {
    this.#captions.setText(text);
  }

  /** Places the mirror at this side of the user; null: on the wall ahead of the user. */
  placeMirror(side: Side | null): void {
    this.#mirrors.place(side);
  }

  /** Stands the mirror on the floor at this height, its middle at (x, z) [m]; turned by 0 it faces +Z [rad]. */
  standMirror(x: number, floor: number, z: number, turned: number): void {
    this.#mirrors.stand(x, floor, z, turned);
  }

  setSkeletonVisible(visible: boolean): void {
    this.#skeleton.setVisible(visible);
  }

  /** Fits picture and camera to the window; insets: what the controls cover [CSS pixels]. */
  layOut(insets: Insets): void {
    this.view.setInsets(insets);
    this.view.resize();
    fitToWindow(this.renderer, this.#quality);
  }

  /** Moves light and camera to where the body is: before anything is drawn that depends on the camera. */
  look({ time, frame, avatar, inSession, span, watched, beside }: Picture): void {
    const { view, studio } = this;
    const elapsed = Math.min(longestStep, Math.max(0, time - this.#lastTime));
    this.#lastTime = time;
    const joints = avatar?.jointPositions();
    view.setBodies(avatar?.height ?? 0, span.to - span.from);
    const aside = (span.from + span.to) / 2;
    if (watched) studio.follow({ hips: { ...watched.pelvis, z: outOfSight } });
    else if (joints) studio.follow(joints, beside);
    if (inSession) return;
    if (watched) view.update(watched.pelvis, watched.eyes, elapsed);
    else if (frame) {
      const { position } = frame.head;
      const pelvis = joints?.hips ?? { ...position, y: position.y * pelvisShare };
      view.update(aside === 0 ? pelvis : { ...pelvis, x: pelvis.x + aside }, frame.head, elapsed);
    }
  }

  draw({ time, frame, avatar, inSession, watched, beside, mirror: wanted, savings }: Picture): void {
    const { renderer, view } = this;
    this.#save(savings);
    const inside = inSession || view.view === 'first-person';
    if (avatar) {
      this.#skeleton.setJoints(avatar.jointPositions());
      this.#skeleton.object.position.x = beside;
      avatar.object.position.x = beside;
      avatar.object.visible = watched === null;
      avatar.setOpacity(this.#headLoss.opacityAt(time, frame !== null));
      avatar.setFirstPerson(inside && beside === 0);
    }
    const eyes = inSession && frame ? frame.head : null;
    this.vignette.show(time, eyes);
    this.#captions.show(time, eyes);
    const beforeIt = inside || this.#mirrors.isBeforeWall(view.camera.position);
    this.#mirrors.setVisible(wanted === 'always' || (wanted === 'unless-behind' && beforeIt));
    const camera = inSession ? this.#headsetCamera : view.camera;
    const { scene } = this.studio;
    renderer.info.reset();
    this.#mirrors.reflect(renderer, scene, camera, time);
    this.#count('mirror');
    renderer.render(scene, camera);
    this.#count('scene');
  }

  #save(savings: Savings): void {
    if (savings === this.#savings) return;
    this.#savings = savings;
    this.renderer.xr.setFoveation(savings.foveation);
    this.#mirrors.setMaxRate(savings.mirrorRateHz);
  }

  #count(part: 'mirror' | 'scene'): void {
    const { info } = this.renderer;
    this.drawn[part].drawCalls = info.render.calls;
    this.drawn[part].triangles = info.render.triangles;
    info.reset();
  }
}
