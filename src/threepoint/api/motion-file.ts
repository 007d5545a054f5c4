import { assertCalibration, type Calibration, calibrationFromHeadHeight } from '../core/body/calibration';
import { createEstimator, type NetworkName, networkOf } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import type { EstimatorName } from '../core/estimation/pose-estimator';
import type { Motion } from '../core/motion/motion';
import { estimateMotion } from '../core/motion/take-motion';
import { scaleProgressAsync, type Work } from '../core/motion/work';
import { type BvhOptions, writeBvh } from '../core/motion/write-bvh';
import { writeCsv } from '../core/motion/write-csv';
import { writeVrma } from '../core/motion/write-vrma';
import type { Replayable, TrackingFrames } from '../core/tracking/recording';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { TrackingValidator, validFrames } from '../core/tracking/tracking-validator';
import { type MotionFormat, motionFormats } from './motion-formats';
import { runWork, type WorkOptions } from './run-work';

/** An exported file in memory: `new Blob(parts, {type})`, or written part by part. */
export interface MotionFile {
  /** The file name's extension, without the dot. */
  readonly extension: string;
  readonly type: string;
  readonly parts: readonly (string | Uint8Array<ArrayBuffer>)[];
}

/** Writes motions as files of one format; `avatarMotionWriter` of threepoint/three returns another writer. */
export interface MotionWriter {
  readonly extension: string;
  readonly type: string;
  write(motion: Motion): Work<MotionFile['parts']>;
}

export interface MotionFileOptions extends WorkOptions, BvhOptions {
  readonly format: MotionFormat | MotionWriter;
  /** The estimator of the body between the points; default: 'learned'. */
  readonly estimator?: EstimatorName;
  /** Loads a network by name, as the option of a BodySolver does. It is disposed of at the end. */
  readonly networks: (name: NetworkName) => Promise<PoseRegressor>;
  /** The person's measures [m]. Default: the recording's, else estimated from the head height in its first frame. */
  readonly calibration?: Calibration | undefined;
}

function writerOf({ format, ...options }: MotionFileOptions): MotionWriter {
  if (typeof format === 'object') return format;
  if (format === 'bvh') return { extension: 'bvh', type: 'text/plain', write: (motion) => writeBvh(motion, options) };
  if (format === 'csv') return { extension: 'csv', type: 'text/csv', write: writeCsv };
  if (format === 'vrma') return { extension: 'vrma', type: 'model/gltf-binary', write: writeVrma };
  throw new Error(`“${String(format)}” is not a motion format. Use one of ${motionFormats.join(', ')}.`);
}

/** The fraction of the work that is spent on estimating; the rest is writing. */
const estimating = 0.7;

/** Throws an Error if no frame has a device body: another method would estimate all of them. */
function* requireDeviceBody({ frames }: Replayable): Generator<number, void> {
  for (const { deviceBody } of frames) {
    if (deviceBody) return;
    yield 0;
  }
  throw new Error('The recording has no device body. Choose another method.');
}

/** The valid frames of a recording, which a program may have created; frames without a head are left out. */
class AdmittedRecording implements TrackingFrames {
  readonly #frames: TrackingFrames;

  constructor({ frames }: Replayable) {
    this.#frames = frames;
  }

  /** The largest possible number of frames. */
  get length(): number {
    return this.#frames.length;
  }

  at(index: number): TrackingFrame | undefined {
    return this.#frames.at(index);
  }

  /** Yields the valid frames. Throws an Error if times do not rise, or no frame has a head. */
  *[Symbol.iterator](): Generator<TrackingFrame> {
    const validator = new TrackingValidator();
    let number = 0;
    let last = Number.NEGATIVE_INFINITY;
    for (const frame of this.#frames) {
      number += 1;
      const admitted = validator.validate(frame);
      if (!admitted) continue;
      if (admitted.time <= last)
        throw new Error(`Frame ${number} of the recording is not later than the one before it.`);
      last = admitted.time;
      yield admitted;
    }
    if (last === Number.NEGATIVE_INFINITY) throw new Error('The recording has no frame in which the head is seen.');
  }
}

/** Returns the measures for an export. Throws a RangeError for measures that no person has. */
function personOf({ calibration, frames }: Replayable, given: Calibration | undefined): Calibration {
  const person = given ?? calibration;
  if (!person) {
    const [first] = validFrames(frames);
    return calibrationFromHeadHeight(first?.head.position.y ?? Number.NaN);
  }
  assertCalibration(person);
  return person;
}

async function* exportWork(
  recording: Replayable,
  calibration: Calibration,
  regressor: PoseRegressor | null,
  { estimator = 'learned' }: MotionFileOptions,
  writer: MotionWriter,
): AsyncGenerator<number, MotionFile['parts']> {
  if (estimator === 'device') yield* requireDeviceBody(recording);
  const drawn = createEstimator(estimator, calibration, regressor);
  const admitted = { ...recording, frames: new AdmittedRecording(recording) };
  const motion = yield* scaleProgressAsync(estimateMotion(admitted, calibration, drawn), 0, estimating);
  return yield* scaleProgressAsync(writer.write(motion), estimating, 1);
}

/** Returns the loading network. Rejects as soon as the work is aborted, and disposes of a network that loads later. */
async function untilAborted(loading: Promise<PoseRegressor>, signal: AbortSignal | undefined): Promise<PoseRegressor> {
  if (!signal) return loading;
  let giveUp = (): void => undefined;
  const givenUp = new Promise<never>((_, reject) => {
    giveUp = () => reject(signal.reason);
  });
  signal.addEventListener('abort', giveUp);
  try {
    return await Promise.race([loading, givenUp]);
  } catch (error) {
    loading.then((network) => network.dispose()).catch(() => undefined); // reason: no one waits for it any more
    throw error;
  } finally {
    signal.removeEventListener('abort', giveUp);
  }
}

/**
 * Writes the motion that an estimator makes of a recording; see `exportMotion`. Rejects also if times do not rise, or
 * if 'device' is selected and no frame has a device body.
 */
export async function writeMotionFile(recording: Replayable, options: MotionFileOptions): Promise<MotionFile> {
  const { estimator = 'learned', networks } = options;
  const writer = writerOf(options);
  const calibration = personOf(recording, options.calibration);
  options.signal?.throwIfAborted();
  const network = networkOf(estimator);
  const regressor = network && (await untilAborted(networks(network), options.signal));
  try {
    const parts = await runWork(exportWork(recording, calibration, regressor, options, writer), options);
    return { extension: writer.extension, type: writer.type, parts };
  } finally {
    await regressor?.dispose();
  }
}
