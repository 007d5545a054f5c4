import { Body } from 'threepoint';
import {
  type AvatarPose,
  actorFrame,
  defaultCalibration,
  type EstimatorName,
  estimatorNames,
  recordOf,
  skeletonFromCalibration,
} from 'threepoint/core';
import { nextRandom } from 'threepoint/math';
import { createFrameLoop } from '../../src/page/shell/frame-loop';
import { FrameTiming, stageNames } from '../../src/page/shell/session/frame-timing';
import { quantile } from '../../src/threepoint/core/math/statistics';
import { parseContract, tensorsOf } from '../../src/threepoint/onnx/model-contract';
import { createSession } from '../../src/threepoint/onnx/session';
import { measureArchery } from './archery';
import { measureCourt } from './ball';
import { createCcdBody } from './ccd-body';
import { measureSixteen } from './crowd';
import { timeFrame } from './frame-times';
import { reportOutcome } from './outcome';
import { loadNetwork, openPicture, openStage } from './stage';

/** Blocks of one method alternate in a seeded order, so that other work of the machine meets all of them. */
const blockFrames = 40;
const usualRounds = 12;
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

function quantiles(values: readonly number[]) {
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
    if (body.estimator !== name) throw new Error(`${name}: ${body.unavailableEstimators[name]}`);
    bodies[name] = body;
  }
  return bodies as Record<EstimatorName, Body>;
}

const empty = <Key extends string>(keys: readonly Key[]) => recordOf(keys, (): number[] => []);

/** Returns the median of every block for each method. */
const blockMedians = (values: Record<Method, number[]>): Record<Method, number[]> =>
  recordOf(methods, (name) =>
    Array.from(
      { length: values[name].length / blockFrames },
      (_, block) => quantiles(values[name].slice(block * blockFrames, (block + 1) * blockFrames)).p50,
    ),
  );

type Measured = Readonly<Record<'inFrame' | 'withLater' | 'whole' | 'thread', Record<Method, number[]>>>;

/** Frames of every method in every condition. */
class FrameBench {
  readonly #picture: Awaited<ReturnType<typeof openPicture>>;
  readonly #bodies: Record<EstimatorName, Body>;
  readonly #timing: FrameTiming;
  readonly #ccd = createCcdBody(skeletonFromCalibration(defaultCalibration));
  readonly #measured = recordOf(
    conditions,
    (): Measured => ({
      inFrame: empty(methods),
      withLater: empty(methods),
      whole: empty(methods),
      thread: empty(methods),
    }),
  );
  readonly #stages = recordOf(estimatorNames, () => empty(stageNames));
  readonly #spent = recordOf(stageNames, () => 0);
  readonly #loop: (timestampMs: number) => void;
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

  get costs() {
    const summary = (values: Record<Method, number[]>) => recordOf(methods, (name) => quantiles(values[name]));
    return recordOf(conditions, (condition) => {
      const { inFrame, withLater, whole, thread } = this.#measured[condition];
      return {
        /** Estimate: what the method costs within the animation frame. */
        inFrameMs: summary(inFrame),
        /** And what it leaves for later on the page's thread: features, and asking the network's worker. */
        withLaterMs: summary(withLater),
        /** Until the picture is drawn. */
        frameMs: summary(whole),
        /** The part of it on the page's own thread. */
        threadMs: summary(thread),
      };
    });
  }

  /** Medians of the blocks, settled, in the order of the rounds: those of a round are pairs. */
  get blocks() {
    const { inFrame, thread } = this.#measured.settled;
    return { inFrameMs: blockMedians(inFrame), threadMs: blockMedians(thread) };
  }

  /** Medians, settled. */
  get stagesMs() {
    return recordOf(estimatorNames, (name) =>
      recordOf(stageNames, (stage) => quantiles(this.#stages[name][stage]).p50),
    );
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
    if (name !== 'ccdik') this.#method = name;
    for (const body of Object.values(this.#bodies)) body.discontinuity();
    for (let i = 0; i < settleFrames + blockFrames; i++) {
      // Every method of a round gets the same motion, because the cost of a frame depends on its content.
      const timeMs = ((round * blockFrames + i) * 1000) / 60;
      const spent = await timeFrame(this.#picture.renderer, () => {
        if (name === 'ccdik') this.#solveByCcd(timeMs);
        else this.#estimate(timeMs);
        if (this.#failure) throw this.#failure;
      });
      if (i < settleFrames) continue;
      inFrame[name].push(this.#inFrameMs);
      withLater[name].push(this.#withLaterMs);
      thread[name].push(spent.thread);
      whole[name].push(spent.drawn);
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

async function measureFrames() {
  const opening = { learned: await openingCost('learned'), paper: await openingCost('paper') };
  const timing = new FrameTiming(() => performance.now());
  const rounds = Number(new URLSearchParams(location.search).get('rounds') ?? usualRounds);
  const bodies = await openBodies(timing);
  const bench = new FrameBench(await openPicture(), bodies, timing);
  await bench.run(rounds);
  return {
    costs: bench.costs,
    blocks: bench.blocks,
    stagesMs: bench.stagesMs,
    sessionCreateMs: { learned: opening.learned.create, paper: opening.paper.create },
    firstInferenceMs: { learned: opening.learned.first, paper: opening.paper.first },
    /** The number of frames of each method in each condition. */
    frames: rounds * blockFrames,
  };
}

const measuredParts = {
  frames: measureFrames,
  archery: async () => measureArchery(await openStage()),
  ball: async () => measureCourt(await openStage()),
  crowd: async () => measureSixteen(await openStage()),
};

export type PagePart = keyof typeof measuredParts;
export type PageResult<Part extends PagePart> = Awaited<ReturnType<(typeof measuredParts)[Part]>>;

void reportOutcome(measuredParts[new URLSearchParams(location.search).get('part') as PagePart]);
