import { Body } from 'threepoint';
import {
  type AvatarPose,
  actorFrame,
  defaultCalibration,
  type EstimatorName,
  estimatorNames,
  type PaperMethod,
  recordOf,
  skeletonFromCalibration,
} from 'threepoint/core';
import { median, nextRandom } from 'threepoint/math';
import { createFrameLoop } from '../../src/page/shell/frame-loop';
import { FrameTiming, stageNames } from '../../src/page/shell/session/frame-timing';
import { quantile } from '../../src/threepoint/core/math/statistics';
import { createCcdBody } from './ccd-body';
import { measureSixteen } from './crowd';
import { drawFrame } from './frame-times';
import { reportOutcome } from './outcome';
import { loadNetwork, openPicture } from './stage';

/** Blocks of one method alternate in a seeded order, so that other work of the machine meets all of them. */
const blockFrames = 40;
const usualRounds = 12;
const settleFrames = 10;

const methods = [...estimatorNames, 'ccdik'] as const;
type Method = (typeof methods)[number];

function quantiles(values: readonly number[]) {
  const at = (share: number) => Number(quantile(values, share).toFixed(4));
  return { p50: at(0.5), p95: at(0.95), p99: at(0.99) };
}

/** Every round is dated alike: the same motion for every method. */
const roundClock = { tick: (timestampMs: number) => timestampMs / 1000, paused: false };

/** A body for each method, as the page has one. */
async function openBodies(timing: FrameTiming): Promise<Record<EstimatorName, Body<PaperMethod>>> {
  const bodies: Partial<Record<EstimatorName, Body<PaperMethod>>> = {};
  for (const name of estimatorNames) {
    const body = new Body<PaperMethod>({
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
  return bodies as Record<EstimatorName, Body<PaperMethod>>;
}

/** The times of every method [ms]: of each frame, and in its frame those of each block. */
const emptyTimes = () => recordOf(methods, () => ({ inFrame: [] as number[][], withLater: [] as number[] }));

/** Frames of every method; the canvas is drawn on and not shown, as in a headset. */
class FrameBench {
  readonly #picture: Awaited<ReturnType<typeof openPicture>>;
  readonly #bodies: Record<EstimatorName, Body<PaperMethod>>;
  readonly #timing: FrameTiming;
  readonly #ccd = createCcdBody(skeletonFromCalibration(defaultCalibration));
  readonly #spent = recordOf(stageNames, () => 0);
  readonly #loop: (timestampMs: number) => void;
  #times = emptyTimes();
  #method: EstimatorName = 'ik';
  /** The times of the newest frame [ms]. */
  #inFrameMs = 0;
  #withLaterMs = 0;
  #failure: unknown = null;
  #skinned: AvatarPose | null = null;
  #random = { seed: 20230213 };

  constructor(
    picture: Awaited<ReturnType<typeof openPicture>>,
    bodies: Record<EstimatorName, Body<PaperMethod>>,
    timing: FrameTiming,
  ) {
    this.#picture = picture;
    this.#bodies = bodies;
    this.#timing = timing;
    this.#loop = this.#createLoop();
  }

  /** Measures this many rounds, after as many in which the engine compiles every method. */
  async run(rounds: number): Promise<void> {
    this.#timing.listen((spentMs) => Object.assign(this.#spent, spentMs));
    this.#picture.renderer.domElement.hidden = true;
    for (let round = 0; round < rounds; round++) await this.#runRound(round);
    this.#times = emptyTimes();
    for (let round = 0; round < rounds; round++) await this.#runRound(round);
    this.#timing.listen(null);
  }

  get result() {
    return {
      /** The estimate, within the animation frame. */
      inFrameMs: recordOf(methods, (name) => quantiles(this.#times[name].inFrame.flat())),
      /** The estimate, features and the message to the network's worker, on the page's thread. */
      withLaterMs: recordOf(methods, (name) => quantiles(this.#times[name].withLater)),
      /** The median of each block in the frame, in the order of the rounds: those of a round are pairs. */
      blocksMs: recordOf(methods, (name) => this.#times[name].inFrame.map((block) => median(block))),
    };
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

  async #runRound(round: number): Promise<void> {
    const order = methods.map((name) => {
      const { value, state } = nextRandom(this.#random);
      this.#random = state;
      return { name, value };
    });
    for (const { name } of order.sort((a, b) => a.value - b.value)) await this.#runBlock(name, round);
  }

  async #runBlock(name: Method, round: number): Promise<void> {
    const block: number[] = [];
    if (name !== 'ccdik') this.#method = name;
    for (const body of Object.values(this.#bodies)) body.discontinuity();
    for (let i = 0; i < settleFrames + blockFrames; i++) {
      // Every method of a round gets the same motion, because the cost of a frame depends on its content.
      const timeMs = ((round * blockFrames + i) * 1000) / 60;
      await drawFrame(this.#picture.renderer, () => {
        if (name === 'ccdik') this.#solveByCcd(timeMs);
        else this.#estimate(timeMs);
        if (this.#failure) throw this.#failure;
      });
      if (i < settleFrames) continue;
      block.push(this.#inFrameMs);
      this.#times[name].withLater.push(this.#withLaterMs);
    }
    this.#times[name].inFrame.push(block);
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
  const timing = new FrameTiming(() => performance.now());
  const bench = new FrameBench(await openPicture(), await openBodies(timing), timing);
  await bench.run(Number(new URLSearchParams(location.search).get('rounds') ?? usualRounds));
  return bench.result;
}

const measuredParts = { frames: measureFrames, crowd: measureSixteen };

export type PagePart = keyof typeof measuredParts;
export type PageResult<Part extends PagePart> = Awaited<ReturnType<(typeof measuredParts)[Part]>>;

void reportOutcome(measuredParts[new URLSearchParams(location.search).get('part') as PagePart]);
