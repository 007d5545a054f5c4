import type { Object3D } from 'three';
import type { LoadNetwork } from 'threepoint';
import {
  type AvatarPose,
  type BoneMap,
  type EstimatorName,
  firstLine,
  type PaperMethod,
  type Replayable,
  reasonOf,
  type TrackingFrame,
} from 'threepoint/core';
import type { ReplayState } from 'threepoint/internal';
import { mocapRateHz, type PreparedMocap } from 'threepoint/internal';
import type { WorkProgress } from 'threepoint/motion';
import type { Avatar } from 'threepoint/three';
import { fileNameOf, type Notices } from 'threepoint-ui';
import { ClipMeans } from './clip-means';
import { Ghost } from './ghost';
import { ErrorMeter, makeJointErrors } from './joint-errors';
import { type CardActions, createMocapCard, type Labels, type MocapCard } from './mocap-card';
import { isMap, type MocapFile, pairFiles } from './mocap-files';
import { type BoneMaps, type ClipView, MotionBones, type OpenRequest } from './motion-bones';
import { type ReadMocap, readMocap, UnmatchedMotion } from './read-mocap';
import { SecondBody } from './second-body';
import { recordingOf } from './simulated-recording';
import { Truth } from './truth';
import type { TruthPlace } from './truth-places';

/** The page's replay, which brings a recording's frames to its body. */
interface Replay extends ReplayState {
  readonly duration: number;
  /**
   * Loads a recording. Throws a sentence if another one must not be lost to it. `requestNumber`: its number among the
   * recorder's requests; absent: the newest.
   */
  load(name: string, recording: Replayable, requestNumber?: number): void;
  /** Replays the loaded recording from its start. */
  replay(): void;
  seek(seconds: number): void;
  setPaused(on: boolean): void;
  stop(): void;
}

interface MocapViewOptions {
  readonly scene: Object3D;
  readonly region: HTMLElement;
  readonly labels: Labels;
  readonly replay: Replay;
  /** The method of the page's body, and its replacement by another one. */
  readonly method: { readonly selected: EstimatorName; select(estimator: EstimatorName): void };
  readonly networks: LoadNetwork<PaperMethod>;
  readonly boneMaps: BoneMaps;
  readonly notices: Pick<Notices, 'show'>;
  loadAvatar(): Promise<Avatar>;
  /** Compiles the materials of an object and uploads its textures before it is shown. */
  prepare(object: Object3D): Promise<void>;
  /** The replay was started, stopped or moved to another second: the body's pose jumps. */
  onJump(): void;
  /** The replay was paused or resumed. */
  onChange(): void;
}

interface OpenClip extends ReadMocap {
  readonly name: string;
  readonly sources: readonly MocapFile[];
  readonly index: number;
  readonly recording: Replayable;
  readonly truth: Truth;
  readonly meter: ErrorMeter;
  readonly means: ClipMeans;
}

/** Returns the name, the person, the length and the rate of a motion that was opened, as a sentence. */
function loadedText(name: string, { clips, rateHz }: PreparedMocap): string {
  const seconds = clips.reduce((sum, { frameCount }) => sum + frameCount, 0) / mocapRateHz;
  const pieces = clips.length > 1 ? ` in ${clips.length} pieces` : '';
  return `${name} is open: one person, ${seconds.toFixed(1)} s at ${Number(rateHz.toPrecision(3))} Hz${pieces}.`;
}

/** Returns the public addresses of files; null: they are files of this device. */
const addressesOf = (sources: readonly MocapFile[]): readonly string[] | null =>
  sources.every((source) => typeof source === 'string') ? sources : null;

/** The places of the leftmost and the rightmost body, to the right of the page's body [m]. */
export interface Span {
  readonly from: number;
  readonly to: number;
}

/** The span of the page's body alone. */
const noSpan: Span = { from: 0, to: 0 };
/** The distance of the second body, and of the ground truth beside it, to the right of the body [m]. */
const secondAside = 1.15;
const truthAside = -0.85;

/** Shows motion capture: the ground truth as a ghost, the bodies that methods estimate, and their errors. */
export class MocapView {
  readonly #options: MocapViewOptions;
  readonly #ghosts = [new Ghost(), new Ghost()] as const;
  readonly #card: MocapCard;
  readonly #bones: MotionBones;
  #opened: OpenClip | null = null;
  #visible = true;
  #second: SecondBody | null = null;
  #truthPlace: TruthPlace = 'inside';
  #reading = new AbortController();
  /** The files that were requested last. */
  #requestedFiles: readonly MocapFile[] = [];
  /** Errors in the current frame, of the body and of the second body. */
  readonly #errors = [makeJointErrors(), makeJointErrors()] as const;
  readonly #drawn = [false, false];
  /** Resolves when the ghosts can be drawn without delay. */
  readonly #prepared: Promise<unknown>;

  constructor(options: MocapViewOptions) {
    this.#options = options;
    this.#card = createMocapCard(options.labels, this.#actions());
    this.#bones = new MotionBones({
      boneMaps: options.boneMaps,
      show: (skeleton) => this.#card.show({ skeleton }),
      read: (request, bones) => void this.#read(request, bones),
    });
    options.region.append(this.#card.node);
    this.#prepared = Promise.all(this.#ghosts.map((ghost) => options.prepare(ghost.object)));
    for (const ghost of this.#ghosts) options.scene.add(ghost.object);
    this.#hide();
  }

  /**
   * Reads files of this device or addresses, and shows their motion. A skeleton map alone applies to the previous
   * files. Never rejects: faults become notices, and the shown motion stays.
   */
  async open(given: readonly MocapFile[], view: ClipView = {}, requestNumber?: number): Promise<void> {
    const sources = given.every(isMap) ? [...this.#requestedFiles.filter((file) => !isMap(file)), ...given] : given;
    this.#requestedFiles = sources;
    this.#bones.close();
    await this.#read({ sources, view, requestNumber }, null);
  }

  /** Reads files with the user's map of their bones; null: with one that is stored, or without. */
  async #read(request: OpenRequest, bones: BoneMap | null): Promise<void> {
    const { notices, boneMaps } = this.#options;
    const { sources } = request;
    this.#reading.abort();
    const reading = new AbortController();
    const { signal } = reading;
    this.#reading = reading;
    const name = fileNameOf(sources[0]!);
    const onProgress = (progress: WorkProgress) => this.#card.show({ reading: { name, progress } });
    try {
      onProgress({ fraction: 0, secondsLeft: null });
      const { others, ...files } = pairFiles(sources);
      const read = await readMocap(files, { bones, boneMaps: boneMaps.all }, { signal, onProgress });
      await this.#prepared;
      signal.throwIfAborted();
      const motion = fileNameOf(files.motion);
      this.#show({ name: motion, sources, ...read }, request);
      if (bones && read.map.hash !== null) boneMaps.store(read.map.hash, bones);
      this.#bones.close();
      notices.show('info', loadedText(motion, read.prepared));
      if (others.length > 0)
        notices.show('warning', `One motion is shown at a time. Not opened: ${others.join(', ')}.`);
    } catch (error) {
      if (!signal.aborted) this.#reportFailure(request, bones, error);
    } finally {
      if (this.#reading === reading) this.#card.show({ reading: null });
    }
  }

  /** Reports why files could not be shown. Offers the form for bones that match no humanoid. */
  #reportFailure(request: OpenRequest, bones: BoneMap | null, error: unknown): void {
    const { notices } = this.#options;
    const name = fileNameOf(request.sources[0]!);
    const reason = firstLine(reasonOf(error)).replace(`${name}: `, '');
    if (error instanceof UnmatchedMotion) {
      const { joints, matched, confidence, hash } = error;
      const again = { sources: request.sources, view: request.view };
      this.#bones.offer({ name, request: again, joints, matched, confidence, hash, isShown: false, isOwnMap: false });
    } else if (bones) this.#bones.complain(bones, reason);
    else notices.show('error', `${name} could not be shown: ${reason}`);
  }

  #correctBones(): void {
    const opened = this.#opened;
    if (!opened) return;
    const { name, sources, index, prepared, map } = opened;
    const view = { clip: index, beside: this.#second?.estimator };
    const { hash, isUsed } = map;
    this.#bones.offer({
      name,
      request: { sources, view },
      hash,
      ...prepared.bones,
      isShown: true,
      isOwnMap: isUsed,
    });
  }

  /** The places of the leftmost and the rightmost of the shown bodies, to the right of the page's body [m]. */
  get span(): Span {
    if (!this.#isPlaying) return noSpan;
    return { from: this.#truthPlace === 'beside' ? truthAside : 0, to: this.#second ? secondAside : 0 };
  }

  /** Shows the opened motion, or hides it in a game. */
  setVisible(visible: boolean): void {
    this.#visible = visible;
    this.#card.show({ visible });
  }

  get #isPlaying(): boolean {
    return this.#opened !== null && this.#visible && this.#options.replay.mode === 'replaying';
  }

  /** Updates the second body, the ghosts and the errors to a frame and the body that the page's method draws. */
  frame(frame: TrackingFrame, { body }: AvatarPose): void {
    const { replay } = this.#options;
    if (this.#opened && replay.recording !== this.#opened.recording) this.close();
    const opened = this.#opened;
    if (!opened) return;
    if (!this.#isPlaying) {
      this.#hide();
      return;
    }
    const places = opened.truth.at(replay.seconds);
    const second = this.#second?.update(frame) ?? null;
    for (const [i, drawn] of [body, second].entries()) {
      this.#drawn[i] = drawn !== null;
      if (drawn) opened.meter.measure(drawn, places, this.#errors[i as 0]);
    }
    for (const [i, ghost] of this.#ghosts.entries()) {
      ghost.object.visible =
        this.#truthPlace !== 'off' && (i === 0 || (this.#second !== null && this.#truthPlace === 'inside'));
      if (ghost.object.visible) ghost.show(places, frame.head.orientation);
    }
    if (this.#second) this.#second.object.visible = true;
  }

  /** Updates the card; called several times a second. */
  show(): void {
    const opened = this.#opened;
    if (!opened) return;
    const { replay, method } = this.#options;
    const methods = [method.selected, ...(this.#second ? [this.#second.estimator] : [])];
    this.#card.show({
      state: {
        clips: opened.prepared.clips.map(({ name }) => name),
        clip: opened.index,
        paused: replay.paused || replay.mode !== 'replaying',
        seconds: replay.seconds,
        duration: replay.duration,
        truth: this.#truthPlace,
        shareable: addressesOf(opened.sources) !== null,
        canCorrectBones: opened.sources.every((source) => !isMap(source)),
        doubts: opened.prepared.doubts,
        notes: opened.prepared.notes,
        methods: methods.map((estimator, i) => ({
          estimator,
          now: this.#drawn[i] ? this.#errors[i as 0] : null,
          mean: opened.means.errorsOf(estimator),
        })),
      },
    });
  }

  /** Hides the clip. The replay continues. */
  close(): void {
    this.#opened?.means.dispose();
    this.#opened = null;
    this.#compare(null);
    this.#hide();
    this.#card.show({ state: null });
  }

  /** Shows the effect of a press at once. */
  #change(act: () => void): void {
    act();
    this.show();
  }

  #actions(): CardActions {
    const { replay, method, onJump, onChange } = this.#options;
    return {
      chooseClip: (index) => this.#chooseClip(index),
      setPaused: (on) =>
        this.#change(() => {
          // A replay that was stopped or has ended restarts.
          if (replay.mode === 'replaying') {
            replay.setPaused(on);
            onChange();
          } else this.#seek(0);
        }),
      seek: (seconds) => this.#change(() => this.#seek(seconds)),
      choose: (estimator) => this.#change(() => method.select(estimator)),
      compare: (estimator) => this.#change(() => this.#compare(estimator)),
      placeTruth: (place) => this.#change(() => this.#placeTruth(place)),
      copyLink: () => void this.#copyLink(),
      correctBones: () => this.#correctBones(),
      applyBones: (bones) => this.#bones.apply(bones),
      cancelBones: () => this.#bones.close(),
      cancel: () => this.#reading.abort(),
      close: () => {
        replay.stop();
        onJump();
        this.close();
      },
    };
  }

  #show(
    read: ReadMocap & Pick<OpenClip, 'name' | 'sources'>,
    { view, requestNumber }: Pick<OpenRequest, 'view' | 'requestNumber'>,
  ): void {
    const { clips } = read.prepared;
    const longest = clips.reduce((best, { frameCount }, i) => (frameCount > clips[best]!.frameCount ? i : best), 0);
    const index = clips[view.clip ?? longest] ? (view.clip ?? longest) : longest;
    const clip = clips[index]!;
    const recording = recordingOf(clip);
    const { replay, networks, onJump } = this.#options;
    // If this throws, the shown motion stays.
    replay.load(clip.name, recording, requestNumber);
    replay.replay();
    onJump();
    this.close();
    const truth = new Truth(clip);
    const means = new ClipMeans(recording, truth, networks);
    this.#opened = { ...read, index, recording, truth, means, meter: new ErrorMeter(clip.calibration) };
    this.#placeTruth(view.truth ?? this.#truthPlace);
    if (view.beside) this.#compare(view.beside);
    if (view.at !== undefined) {
      replay.seek(view.at);
      replay.setPaused(true);
      onJump();
    }
    this.show();
  }

  #chooseClip(clip: number): void {
    const opened = this.#opened;
    if (opened) this.#show(opened, { view: { clip, beside: this.#second?.estimator } });
  }

  #seek(seconds: number): void {
    const { replay, onJump } = this.#options;
    replay.seek(seconds);
    onJump();
    this.#second?.discontinuity();
  }

  #placeTruth(place: TruthPlace): void {
    this.#truthPlace = place;
    const [first, second] = this.#ghosts;
    first.object.position.x = place === 'beside' ? truthAside : 0;
    second.object.position.x = secondAside;
  }

  #compare(estimator: EstimatorName | null): void {
    this.#second?.dispose();
    this.#second = null;
    this.#drawn[1] = false;
    const clip = this.#opened?.prepared.clips[this.#opened.index];
    if (!clip || !estimator) return;
    const { scene, networks, replay, loadAvatar, labels, notices } = this.#options;
    this.#second = new SecondBody({
      scene,
      networks,
      replay,
      loadAvatar,
      estimator,
      calibration: clip.calibration,
      aside: secondAside,
      onFallback: ({ estimator: name, reason }) =>
        notices.show(
          'warning',
          `${labels[name]} could not be used, so inverse kinematics takes over. Reason: ${firstLine(reason)}`,
        ),
    });
    this.#second.ready.catch((error: unknown) =>
      notices.show('error', `The second body could not be shown: ${firstLine(reasonOf(error))}`),
    );
  }

  #hide(): void {
    for (const ghost of this.#ghosts) ghost.object.visible = false;
    if (this.#second) this.#second.object.visible = false;
    this.#drawn.fill(false);
  }

  /** Copies a link to this file, time and methods. The address of the page becomes the link too. */
  async #copyLink(): Promise<void> {
    const { replay, method, notices } = this.#options;
    const opened = this.#opened;
    const addresses = opened && addressesOf(opened.sources);
    if (!addresses) return;
    const link = new URL(location.href);
    const { searchParams } = link;
    searchParams.set('mocap', addresses.join(' '));
    searchParams.set('at', replay.seconds.toFixed(2));
    searchParams.set('estimator', method.selected);
    searchParams.set('truth', this.#truthPlace);
    if (this.#second) searchParams.set('beside', this.#second.estimator);
    else searchParams.delete('beside');
    if (opened.prepared.clips.length > 1) searchParams.set('clip', String(opened.index + 1));
    history.replaceState(null, '', link);
    try {
      await navigator.clipboard.writeText(link.href);
      notices.show('info', 'The link is copied.');
    } catch {
      // reason: a browser may refuse; the address bar has the link then.
      notices.show('info', 'The link is in the address bar.');
    }
  }
}
