import { assertCalibration, type Calibration, calibrationFromHeadHeight } from '../core/body/calibration';
import { createEstimator, networkOf } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { estimateMotion } from '../core/motion/take-motion';
import { scaleProgressAsync } from '../core/motion/work';
import { writeBvh } from '../core/motion/write-bvh';
import { writeCsv } from '../core/motion/write-csv';
import { writeVrma } from '../core/motion/write-vrma';
import type { Replayable, TrackingFrames } from '../core/tracking/recording';
import { TrackingGate, validFrames } from '../core/tracking/tracking-gate';
import { type MotionFile, type MotionFileOptions, type MotionWriter, motionFormats } from './motion-file';
import { runWork } from './run-work';

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

/**
 * Returns the valid frames of a recording, which a program may have created: frames without a head are left out. Their
 * iterator throws an Error if times do not rise, or no frame has a head. `length`: the largest possible number.
 */
const validFramesOf = (frames: TrackingFrames): TrackingFrames => ({
  length: frames.length,
  at: (index) => frames.at(index),
  *[Symbol.iterator]() {
    const gate = new TrackingGate();
    let number = 0;
    let last = Number.NEGATIVE_INFINITY;
    for (const frame of frames) {
      number += 1;
      const valid = gate.validate(frame);
      if (!valid) continue;
      if (valid.time <= last) throw new Error(`Frame ${number} of the recording is not later than the one before it.`);
      last = valid.time;
      yield valid;
    }
    if (last === Number.NEGATIVE_INFINITY) throw new Error('The recording has no frame in which the head is seen.');
  },
});

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
  const valid = { ...recording, frames: validFramesOf(recording.frames) };
  const motion = yield* scaleProgressAsync(estimateMotion(valid, calibration, drawn), 0, estimating);
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
