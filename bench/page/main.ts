import { PerspectiveCamera } from 'three';
import { Body } from 'threepoint/api/body';
import { createAvatar } from 'threepoint/avatar/avatar';
import { parseAvatar } from 'threepoint/avatar/load-avatar';
import { createMirror } from 'threepoint/avatar/mirror';
import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import { defaultCalibration } from 'threepoint/core/body/calibration';
import { skeletonFromCalibration } from 'threepoint/core/body/skeleton';
import { createEstimator, type NetworkName, needsRegressor } from 'threepoint/core/estimation/estimators';
import type { PoseRegressor } from 'threepoint/core/estimation/networks/pose-regressor';
import { type EstimatorName, estimatorNames, type PoseEstimator } from 'threepoint/core/estimation/pose-estimator';
import { nextRandom } from 'threepoint/core/math/random';
import { quantile } from 'threepoint/core/math/statistics';
import { actorFrame } from 'threepoint/core/tracking/actor-motion';
import { createInferenceWorker } from 'threepoint/onnx/create-inference-worker';
import { loadRegressor } from 'threepoint/onnx/load-regressor';
import { parseContract, tensorsOf } from 'threepoint/onnx/model-contract';
import { createSession } from 'threepoint/onnx/session';
import { createRenderer } from 'threepoint-page/scene/renderer';
import { createFrameLoop } from 'threepoint-page/shell/frame-loop';
import { createFrameTiming, type FrameTiming, type StageName, stageNames } from 'threepoint-page/shell/frame-timing';
import { createStudio } from 'threepoint-page/studio/studio';
import { measureArchery, type RoundTimes } from './archery';
import { type CourtTimes, measureCourt } from './ball';
import { createCcdBody } from './ccd-body';
import { type CrowdTimes, measureSixteen } from './crowd';
import { nextFrame } from './frame-times';

/** Blocks of one method alternate in a seeded order, so that other work of the machine meets all of them. */
const blockFrames = 40;
const usualRounds = 12;
const crowdRounds = 30;
const settleFrames = 10;

/**
 * first: the first ten seconds of every method, while the engine still compiles it. settled: after them. In both the
 * canvas is drawn on and not shown, as in a headset. shown: settled, and the browser copies the canvas into its window,
 * which without a GPU takes the cores away from the next frame.
 */
const conditions = ['first', 'settled', 'shown'] as const;
type Condition = (typeof conditions)[number];

const methods = [...estimatorNames, 'ccdik'] as const;
export type Method = (typeof methods)[number];

interface Quantiles {
  readonly p50: number;
  readonly p95: number;
  readonly p99: number;
}

/** The costs under one condition, by method. */
interface Costs {
  /** Estimate: what the method costs within the animation frame. */
  readonly inFrameMs: Readonly<Record<Method, Quantiles>>;
  /** And what it leaves for later on the page's thread: features, and asking the network's worker. */
  readonly withLaterMs: Readonly<Record<Method, Quantiles>>;
  /** Until the picture is drawn. */
  readonly frameMs: Readonly<Record<Method, Quantiles>>;
  /** The part of it on the page's own thread. */
  readonly threadMs: Readonly<Record<Method, Quantiles>>;
}

export interface PageResult {
  readonly costs: Readonly<Record<Condition, Costs>>;
  /** Medians of the blocks, settled, in the order of the rounds: those of a round are pairs. */
  readonly blocks: Readonly<Record<'inFrameMs' | 'threadMs', Readonly<Record<Method, readonly number[]>>>>;
  /** Medians, settled. */
  readonly stagesMs: Readonly<Record<EstimatorName, Readonly<Record<StageName, number>>>>;
  readonly sessionCreateMs: Readonly<Record<string, number>>;
  readonly firstInferenceMs: Readonly<Record<string, number>>;
  /** The number of frames of each method in each condition. */
  readonly frames: number;
  /** A whole round of archery with each estimator. */
  readonly archery: Readonly<Record<string, RoundTimes>>;
  /** The ball court with 1, 3, 8 and 16 avatars, with each estimator. */
  readonly ball: Readonly<Record<string, readonly CourtTimes[]>>;
  /** The own body and fifteen others; null: not measured. */
  readonly crowd: CrowdTimes | null;
}

function quantiles(values: readonly number[]): Quantiles {
  const at = (share: number) => Number(quantile(values, share).toFixed(4));
  return { p50: at(0.5), p95: at(0.95), p99: at(0.99) };
}

/** What opening a model costs, apart from its download. */
async function openingCost(name: string): Promise<{ readonly create: number; readonly first: number }> {
  const contract = parseContract(name, await (await fetch(`/models/${name}.json`)).text());
  const model = new Uint8Array(await (await fetch(`/models/${contract.file}`)).arrayBuffer());
  const started = performance.now();
  const tensors = tensorsOf(contract);
  const session = await createSession(model, tensors, 'wasm');
  const created = performance.now();
  await session.run(new Float32Array(tensors.inputShape.reduce((a, b) => a * b, 1)));
  const ran = performance.now();
  await session.release();
  return { create: created - started, first: ran - created };
}

/** What is drawn in every frame, as on the page. */
async function openPicture() {
  const canvas = document.querySelector('canvas');
  if (!canvas) throw new Error('no canvas');
  const renderer = createRenderer(canvas, 'low');
  renderer.setSize(480, 270, false);
  const studio = createStudio(renderer, 'low');
  // The page's settings for software rendering.
  const mirror = createMirror({ distance: 1.5, resolution: 256, samples: 0 });
  const mannequin = await (await fetch('/avatars/mannequin.vrm')).arrayBuffer();
  const avatar = createAvatar(await parseAvatar(mannequin, 'mannequin.vrm'));
  studio.scene.add(mirror.object, avatar.object);
  avatar.setCalibration(defaultCalibration);
  const camera = new PerspectiveCamera(42, 480 / 270, 0.05, 90);
  camera.position.set(1.9, 1.5, 2.75);
  camera.lookAt(0, 1, -0.4);
  return { renderer, studio, mirror, avatar, camera, mannequin };
}

/** For games, which ask their network themselves. */
async function openEstimators(): Promise<Record<EstimatorName, PoseEstimator>> {
  const regressors: Partial<Record<Method, PoseRegressor>> = {};
  for (const name of estimatorNames.filter(needsRegressor)) regressors[name] = await loadNetwork(name);
  return Object.fromEntries(
    estimatorNames.map((name) => [name, createEstimator(name, defaultCalibration, regressors[name] ?? null)]),
  ) as Record<EstimatorName, PoseEstimator>;
}

const loadNetwork = (name: NetworkName): Promise<PoseRegressor> =>
  loadRegressor(`/models/${name}.json`, { createWorker: createInferenceWorker });

/** Every round is dated alike: the same motion for every method. */
const roundClock = { tick: (timestampMs: number) => timestampMs / 1000, paused: false };

/** A body for each method, as the page has one. */
async function openBodies(timing: FrameTiming): Promise<Record<EstimatorName, Body>> {
  const bodies: Partial<Record<EstimatorName, Body>> = {};
  for (const name of estimatorNames) {
    const body = new Body({
      estimator: 'ik',
      calibration: defaultCalibration,
      networks: loadNetwork,
      clock: roundClock,
      profiler: timing,
    });
    await body.setEstimator(name);
    if (body.estimator !== name) throw new Error(`${name}: ${body.unavailable[name]}`);
    bodies[name] = body;
  }
  return bodies as Record<EstimatorName, Body>;
}

const empty = <Key extends string>(keys: readonly Key[]) =>
  Object.fromEntries(keys.map((key) => [key, [] as number[]])) as Record<Key, number[]>;

/** Returns the median of every block for each method. */
const blockMedians = (values: Record<Method, number[]>): Record<Method, number[]> =>
  Object.fromEntries(
    methods.map((name) => [
      name,
      Array.from(
        { length: values[name].length / blockFrames },
        (_, block) => quantiles(values[name].slice(block * blockFrames, (block + 1) * blockFrames)).p50,
      ),
    ]),
  ) as Record<Method, number[]>;

type Measured = Readonly<Record<'inFrame' | 'withLater' | 'whole' | 'thread', Record<Method, number[]>>>;

/** Frames of every method in every condition. */
class FrameBench {
  readonly #picture: Awaited<ReturnType<typeof openPicture>>;
  readonly #bodies: Record<EstimatorName, Body>;
  readonly #timing: FrameTiming;
  readonly #ccd = createCcdBody(skeletonFromCalibration(defaultCalibration));
  readonly #measured = Object.fromEntries(
    conditions.map((condition) => [
      condition,
      { inFrame: empty(methods), withLater: empty(methods), whole: empty(methods), thread: empty(methods) },
    ]),
  ) as Record<Condition, Measured>;
  readonly #stages = Object.fromEntries(estimatorNames.map((name) => [name, empty(stageNames)])) as Record<
    EstimatorName,
    Record<StageName, number[]>
  >;
  readonly #spent = Object.fromEntries(stageNames.map((stage) => [stage, 0])) as Record<StageName, number>;
  readonly #loop: (timestampMs: number) => void;
  readonly #pixel = new Uint8Array(4);
  #method: EstimatorName = 'ik';
  /** What the newest frame took [ms]. */
  #inFrameMs = 0;
  #withLaterMs = 0;
  #failure: unknown = null;
  #skinned: AvatarPose | null = null;
  #random = { seed: 20230213 };

  constructor(
    picture: Awaited<ReturnType<typeof openPicture>>,
    bodies: Record<EstimatorName, Body>,
    timing: FrameTiming,
  ) {
    this.#picture = picture;
    this.#bodies = bodies;
    this.#timing = timing;
    this.#loop = this.#createLoop();
  }

  async run(rounds: number): Promise<void> {
    this.#timing.listen((spentMs) => Object.assign(this.#spent, spentMs));
    for (let round = 0; round < rounds; round++) await this.#runRound(round, 'first');
    for (let round = 0; round < rounds; round++) {
      await this.#runRound(round, 'settled');
      await this.#runRound(round, 'shown');
    }
    this.#timing.listen(null);
  }

  get costs(): Record<Condition, Costs> {
    const summary = (values: Record<Method, number[]>) =>
      Object.fromEntries(methods.map((name) => [name, quantiles(values[name])])) as Record<Method, Quantiles>;
    const costsOf = ({ inFrame, withLater, whole, thread }: Measured): Costs => ({
      inFrameMs: summary(inFrame),
      withLaterMs: summary(withLater),
      frameMs: summary(whole),
      threadMs: summary(thread),
    });
    return Object.fromEntries(conditions.map((condition) => [condition, costsOf(this.#measured[condition])])) as Record<
      Condition,
      Costs
    >;
  }

  get blocks(): PageResult['blocks'] {
    const { inFrame, thread } = this.#measured.settled;
    return { inFrameMs: blockMedians(inFrame), threadMs: blockMedians(thread) };
  }

  get stagesMs(): Record<EstimatorName, Record<StageName, number>> {
    const medians = (name: EstimatorName) =>
      Object.fromEntries(stageNames.map((stage) => [stage, quantiles(this.#stages[name][stage]).p50]));
    return Object.fromEntries(estimatorNames.map((name) => [name, medians(name)])) as Record<
      EstimatorName,
      Record<StageName, number>
    >;
  }

  #createLoop(): (timestampMs: number) => void {
    return createFrameLoop<never>(
      {
        track: (time) => actorFrame(time, defaultCalibration),
        observe: () => undefined,
        estimate: (frame) => this.#bodies[this.#method].update(frame, defaultCalibration),
        skin: (pose, frame) => {
          this.#picture.avatar.setPose(pose, frame.time);
          if (pose.body) this.#skinned = pose;
        },
        render: (time) => this.#draw(time),
        fail: (error) => {
          this.#failure = error;
        },
      },
      roundClock,
      this.#timing,
    );
  }

  #draw(time: number): void {
    const { mirror, renderer, studio, camera } = this.#picture;
    mirror.reflect(renderer, studio.scene, camera, time);
    renderer.render(studio.scene, camera);
  }

  async #runRound(round: number, condition: Condition): Promise<void> {
    this.#picture.renderer.domElement.hidden = condition !== 'shown';
    const order = methods.map((name) => {
      const { value, state } = nextRandom(this.#random);
      this.#random = state;
      return { name, value };
    });
    for (const { name } of order.sort((a, b) => a.value - b.value)) await this.#runBlock(name, round, condition);
  }

  async #runBlock(name: Method, round: number, condition: Condition): Promise<void> {
    const { inFrame, withLater, whole, thread } = this.#measured[condition];
    const gl = this.#picture.renderer.getContext();
    if (name !== 'ccdik') this.#method = name;
    for (const body of Object.values(this.#bodies)) body.discontinuity();
    for (let i = 0; i < settleFrames + blockFrames; i++) {
      await nextFrame();
      // Every method of a round gets the same motion, because the cost of a frame depends on its content.
      const timeMs = ((round * blockFrames + i) * 1000) / 60;
      const started = performance.now();
      if (name === 'ccdik') this.#solveByCcd(timeMs);
      else this.#estimate(timeMs);
      if (this.#failure) throw this.#failure;
      const ended = performance.now();
      // Commands are only queued so far: asking for a pixel waits until all of them are drawn.
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, this.#pixel);
      if (i < settleFrames) continue;
      inFrame[name].push(this.#inFrameMs);
      withLater[name].push(this.#withLaterMs);
      thread[name].push(ended - started);
      whole[name].push(performance.now() - started);
      if (name === 'ccdik' || condition !== 'settled') continue;
      for (const stage of stageNames) this.#stages[name][stage].push(this.#spent[stage]);
    }
  }

  #estimate(timeMs: number): void {
    this.#loop(timeMs);
    const { kinematics, features, inference } = this.#spent;
    this.#inFrameMs = kinematics;
    this.#withLaterMs = features + inference + kinematics;
  }

  #solveByCcd(timeMs: number): void {
    const frame = actorFrame(timeMs / 1000, defaultCalibration);
    const solving = performance.now();
    this.#ccd.solve(frame);
    this.#inFrameMs = performance.now() - solving;
    this.#withLaterMs = this.#inFrameMs;
    // It solves a rig of its own; the avatar is skinned all the same, so that the frame is as much work.
    if (this.#skinned) this.#picture.avatar.setPose(this.#skinned, frame.time);
    this.#draw(frame.time);
  }
}

async function measure(): Promise<PageResult> {
  const opening = { learned: await openingCost('learned'), paper: await openingCost('paper') };
  const picture = await openPicture();
  const timing = createFrameTiming(() => performance.now());
  const asked = new URLSearchParams(location.search);
  const parts = asked.get('parts')?.split(',') ?? ['frames', 'archery', 'ball'];
  const rounds = Number(asked.get('rounds') ?? usualRounds);
  const bodies = await openBodies(timing);
  const bench = new FrameBench(picture, bodies, timing);
  if (parts.includes('frames')) await bench.run(rounds);
  for (const body of Object.values(bodies)) await body.dispose();
  const estimators = await openEstimators();
  const archery = parts.includes('archery') ? await measureArchery({ ...picture, estimators }) : {};
  const ball = parts.includes('ball') ? await measureCourt({ ...picture, estimators }) : {};
  const crowd = parts.includes('crowd') ? await measureSixteen({ ...picture, estimators }, crowdRounds) : null;
  return {
    costs: bench.costs,
    blocks: bench.blocks,
    stagesMs: bench.stagesMs,
    sessionCreateMs: { learned: opening.learned.create, paper: opening.paper.create },
    firstInferenceMs: { learned: opening.learned.first, paper: opening.paper.first },
    frames: rounds * blockFrames,
    archery,
    ball,
    crowd,
  };
}

declare global {
  interface Window {
    benchResult?: PageResult;
    benchError?: string;
  }
}

measure().then(
  (result) => {
    window.benchResult = result;
  },
  (error: unknown) => {
    window.benchError = error instanceof Error ? (error.stack ?? error.message) : String(error);
  },
);
