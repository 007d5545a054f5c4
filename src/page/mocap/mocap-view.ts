import type { Object3D } from 'three';
import type { BodySolverOptions } from 'threepoint/api/body-solver';
import type { ReplayState } from 'threepoint/api/replayed-body';
import type { Avatar } from 'threepoint/avatar/avatar';
import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import type { EstimatorName } from 'threepoint/core/estimation/pose-estimator';
import type { BoneMap } from 'threepoint/core/humanoid/bones';
import type { Replayable } from 'threepoint/core/tracking/recording';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { fileNameOf } from 'threepoint-ui/limited-files';
import type { Notices } from 'threepoint-ui/notices';
import { ClipMeans } from './clip-means';
import { Ghost } from './ghost';
import { ErrorMeter, makeJointErrors } from './joint-errors';
import { type CardActions, createMocapCard, type Labels, type MocapCard } from './mocap-card';
import { isMap, type MocapFile, pairFiles } from './mocap-files';
import { type BoneMaps, MotionBones } from './motion-bones';
import { type ReadMocap, readMocap, UnmatchedMotion } from './read-mocap';
import { SecondBody } from './second-body';
import { recordingOf } from './simulated-recording';
import { Truth } from './truth';
import type { TruthPlace } from './truth-places';

/** The page's replay, which brings a recording's frames to its body. */
export interface Replay extends ReplayState {
  readonly duration: number;
  /**
   * Loads a recording. Throws a sentence where another one must not be lost to it. `asked`: the number of the request;
   * absent: the newest.
   */
  load(name: string, recording: Replayable, asked?: number): void;
  /** Replays the loaded recording from its start. */
  replay(): void;
  seek(seconds: number): void;
  setPaused(on: boolean): void;
  stop(): void;
}

/** How a clip is to be looked at; what is absent stays as it is. */
export interface Outlook {
  /** The index of the clip, from 0. */
  readonly clip?: number | undefined;
  /** Stands still at this second. */
  readonly at?: number | undefined;
  readonly beside?: EstimatorName | undefined;
  readonly truth?: TruthPlace | undefined;
}

export interface MocapViewOptions {
  readonly scene: Object3D;
  readonly region: HTMLElement;
  readonly labels: Labels;
  readonly replay: Replay;
  /** The method of the page's body. */
  readonly method: { readonly wanted: EstimatorName; choose(estimator: EstimatorName): void };
  readonly networks: BodySolverOptions['networks'];
  readonly boneMaps: BoneMaps;
  readonly notices: Pick<Notices, 'show'>;
  loadAvatar(): Promise<Avatar>;
  /** Brings what an object needs to the graphics device before it is seen. */
  prepare(object: Object3D): Promise<void>;
  /** The replay was started, stopped or moved to another second: the body's pose jumps. */
  onJump(): void;
  /** The replay was paused or resumed. */
  onChange(): void;
}

/** Files to open. */
interface Request {
  readonly sources: readonly MocapFile[];
  readonly outlook: Outlook;
  /** Its place among the wishes; absent: the newest. */
  readonly asked?: number | undefined;
}

/** A clip on the stage. */
interface Opened extends ReadMocap {
  readonly name: string;
  readonly sources: readonly MocapFile[];
  readonly index: number;
  readonly recording: Replayable;
  readonly truth: Truth;
  readonly meter: ErrorMeter;
  readonly means: ClipMeans;
}

/** Returns the public addresses of files; null: they are files of this device. */
const addressesOf = (sources: readonly MocapFile[]): readonly string[] | null =>
  sources.every((source) => typeof source === 'string') ? sources : null;

/** The distance of the second body, and of the ground truth beside it, to the right of the body [m]. */
const secondAside = 1.15;
const truthAside = -0.85;

/**
 * Motion capture on the stage: the truth as a ghost, what methods draw of its three points, and how far they are off.
 */
export class MocapView {
  readonly #options: MocapViewOptions;
  readonly #ghosts = [new Ghost(), new Ghost()] as const;
  readonly #card: MocapCard;
  readonly #bones: MotionBones<Request>;
  #opened: Opened | null = null;
  #second: SecondBody | null = null;
  #truthPlace: TruthPlace = 'inside';
  #reading = new AbortController();
  /** The files that were requested last. */
  #asked: readonly MocapFile[] = [];
  /** Errors of the picture: of the body, and of the second. */
  readonly #errors = [makeJointErrors(), makeJointErrors()] as const;
  readonly #drawn = [false, false];
  /** Resolves when the ghosts' first picture waits for nothing. */
  readonly #prepared: Promise<unknown>;

  constructor(options: MocapViewOptions) {
    this.#options = options;
    this.#card = createMocapCard(options.labels, this.#actions());
    this.#bones = new MotionBones<Request>({
      boneMaps: options.boneMaps,
      show: (skeleton) => {
        this.#card.showBones(skeleton);
      },
      read: (request, bones) => void this.#read(request, bones),
    });
    options.region.append(this.#card.node);
    this.#prepared = Promise.all(this.#ghosts.map((ghost) => options.prepare(ghost.object)));
    for (const ghost of this.#ghosts) options.scene.add(ghost.object);
    this.#card.show(null);
    this.#hide();
  }

  /**
   * Reads files of this device or addresses, and shows their motion. A skeleton map alone applies to the previous
   * files. Never rejects: faults become notices, and the shown motion stays.
   */
  async open(given: readonly MocapFile[], outlook: Outlook = {}, asked?: number): Promise<void> {
    // A map that comes alone is of the motion that came before it.
    const sources = given.every(isMap) ? [...this.#asked.filter((file) => !isMap(file)), ...given] : given;
    this.#asked = sources;
    this.#bones.close();
    await this.#read({ sources, outlook, asked }, null);
  }

  /** Reads files with the user's map of their bones; null: with one that is stored, or without. */
  async #read(request: Request, bones: BoneMap | null): Promise<void> {
    const { notices, boneMaps } = this.#options;
    const { sources } = request;
    this.#reading.abort();
    const reading = new AbortController();
    const { signal } = reading;
    this.#reading = reading;
    const name = fileNameOf(sources[0]!);
    const onProgress = (progress: Parameters<MocapCard['showProgress']>[1]) => this.#card.showProgress(name, progress);
    try {
      onProgress({ fraction: 0, secondsLeft: null });
      const { others, ...files } = pairFiles(sources);
      const read = await readMocap(files, { bones, boneMaps: boneMaps.all }, { signal, onProgress });
      await this.#prepared;
      signal.throwIfAborted();
      const motion = fileNameOf(files.motion);
      this.#show({ name: motion, sources, ...read }, request);
      if (bones && read.map.hash !== null) boneMaps.keep(read.map.hash, bones);
      this.#bones.close();
      for (const note of read.prepared.notes) notices.show('info', `${motion}: ${note}.`);
      if (others.length > 0)
        notices.show('warning', `One motion is shown at a time: ${others.join(', ')} was not opened.`);
    } catch (error) {
      if (!signal.aborted) this.#refuse(request, bones, error);
    } finally {
      if (this.#reading === reading) this.#card.showProgress(name, null);
    }
  }

  /** Says why files could not be shown; bones that match no humanoid can be mapped. */
  #refuse(request: Request, bones: BoneMap | null, error: unknown): void {
    const { notices } = this.#options;
    const name = fileNameOf(request.sources[0]!);
    const reason = firstLine(reasonOf(error)).replace(`${name}: `, '');
    if (error instanceof UnmatchedMotion) {
      const { joints, matched, confidence, hash } = error;
      const again = { sources: request.sources, outlook: request.outlook };
      this.#bones.offer({ name, request: again, joints, matched, confidence, hash, isShown: false, isOwnMap: false });
    } else if (bones) this.#bones.complain(bones, reason);
    else notices.show('error', `${name} could not be shown: ${reason}`);
  }

  #correctBones(): void {
    const opened = this.#opened;
    if (!opened) return;
    const { name, sources, index, prepared, map } = opened;
    const outlook = { clip: index, beside: this.#second?.estimator };
    const { hash, isUsed } = map;
    this.#bones.offer({
      name,
      request: { sources, outlook },
      hash,
      ...prepared.bones,
      isShown: true,
      isOwnMap: isUsed,
    });
  }

  /** The distance of the middle of all shown bodies to the right of the page's body [m]. */
  get aside(): number {
    if (!this.#opened || this.#options.replay.mode !== 'replaying') return 0;
    const [left, right] = [this.#truthPlace === 'beside' ? truthAside : 0, this.#second ? secondAside : 0];
    return (left + right) / 2;
  }

  /** One frame of the page: what was tracked, and the body that its method draws. */
  frame(frame: TrackingFrame, { body }: AvatarPose): void {
    const { replay } = this.#options;
    if (this.#opened && replay.recording !== this.#opened.recording) this.close();
    const opened = this.#opened;
    if (!opened) return;
    if (replay.mode !== 'replaying') {
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
    if (this.#second) this.#second.place.visible = true;
  }

  /** Brings the card up to date; some times a second. */
  show(): void {
    const opened = this.#opened;
    if (!opened) return;
    const { replay, method } = this.#options;
    const methods = [method.wanted, ...(this.#second ? [this.#second.estimator] : [])];
    this.#card.show({
      clips: opened.prepared.clips.map(({ name }) => name),
      clip: opened.index,
      paused: replay.paused || replay.mode !== 'replaying',
      seconds: replay.seconds,
      duration: replay.duration,
      truth: this.#truthPlace,
      shareable: addressesOf(opened.sources) !== null,
      canCorrectBones: opened.sources.every((source) => !isMap(source)),
      doubts: opened.prepared.doubts,
      methods: methods.map((estimator, i) => ({
        estimator,
        now: this.#drawn[i] ? this.#errors[i as 0] : null,
        mean: opened.means.of(estimator),
      })),
    });
  }

  /** Takes the clip from the stage; the replay stays as it is. */
  close(): void {
    this.#opened?.means.dispose();
    this.#opened = null;
    this.#compare(null);
    this.#hide();
    this.#card.show(null);
  }

  #actions(): CardActions {
    const { replay, method, onJump, onChange } = this.#options;
    return {
      chooseClip: (index) => this.#chooseClip(index),
      setPaused: (on) => {
        // A replay that was stopped or has ended restarts.
        if (replay.mode === 'replaying') {
          replay.setPaused(on);
          onChange();
        } else this.#seek(0);
        this.show();
      },
      seek: (seconds) => {
        this.#seek(seconds);
        this.show();
      },
      choose: (estimator) => method.choose(estimator),
      compare: (estimator) => this.#compare(estimator),
      placeTruth: (place) => this.#placeTruth(place),
      copyLink: () => void this.#copyLink(),
      correctBones: () => this.#correctBones(),
      giveBones: (bones) => this.#bones.give(bones),
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
    read: ReadMocap & Pick<Opened, 'name' | 'sources'>,
    { outlook, asked }: Pick<Request, 'outlook' | 'asked'>,
  ): void {
    const { clips } = read.prepared;
    const longest = clips.reduce((best, { frameCount }, i) => (frameCount > clips[best]!.frameCount ? i : best), 0);
    const index = clips[outlook.clip ?? longest] ? (outlook.clip ?? longest) : longest;
    const clip = clips[index]!;
    const recording = recordingOf(clip);
    const { replay, networks, onJump } = this.#options;
    // If this throws, the shown motion stays.
    replay.load(`${clip.name}.json`, recording, asked);
    replay.replay();
    onJump();
    this.close();
    const truth = new Truth(clip);
    const means = new ClipMeans(recording, truth, networks);
    this.#opened = { ...read, index, recording, truth, means, meter: new ErrorMeter(clip.calibration) };
    this.#placeTruth(outlook.truth ?? this.#truthPlace);
    if (outlook.beside) this.#compare(outlook.beside);
    if (outlook.at !== undefined) {
      replay.seek(outlook.at);
      replay.setPaused(true);
      onJump();
    }
    this.show();
  }

  #chooseClip(clip: number): void {
    const opened = this.#opened;
    if (opened) this.#show(opened, { outlook: { clip, beside: this.#second?.estimator } });
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
      onFallback: (name, reason) =>
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
    if (this.#second) this.#second.place.visible = false;
    this.#drawn.fill(false);
  }

  /** To this file, second and methods; the address of the page becomes it too. */
  async #copyLink(): Promise<void> {
    const { replay, method, notices } = this.#options;
    const opened = this.#opened;
    const addresses = opened && addressesOf(opened.sources);
    if (!addresses) return;
    const link = new URL(location.href);
    const { searchParams } = link;
    searchParams.set('mocap', addresses.join(' '));
    searchParams.set('at', replay.seconds.toFixed(2));
    searchParams.set('estimator', method.wanted);
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
