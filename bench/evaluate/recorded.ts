// npm run evaluate -- --recording FILE: every method against the body that the recording's device reported.
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';
import { deviceJoint, parseRecording, type Recording, reasonOf, recordOf } from 'threepoint/core';
import { vec3 } from 'threepoint/math';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import { drive, type MeasuredMethod, measuredMethods } from './drive';
import { addClip, emptyMeasures, type Report, report } from './measures';
import { loadRegressors } from './networks';
import { type RecordedFrame, truthJoints } from './recordings';
import { printReports } from './report-text';

/** A gap longer than this [s] is none of a running recording. */
const longestGap = 0.1;
/** Shorter pieces have no jerk to be measured [frames]. */
const shortestPiece = 4;

/** The pieces of a recording in which the device reports its body without a gap, its joints as the truth. */
function piecesOf({ frames }: Recording): readonly (readonly RecordedFrame[])[] {
  const pieces: RecordedFrame[][] = [];
  let last = Number.NEGATIVE_INFINITY;
  for (const frame of frames) {
    const { deviceBody, time } = frame;
    if (!deviceBody) continue;
    const truth = recordOf(truthJoints, (joint) =>
      deviceJoint(deviceBody, joint, vec3(0, 0, 0)),
    ) as RecordedFrame['truth'];
    if (time - last > longestGap) pieces.push([]);
    pieces.at(-1)?.push({ frame, truth });
    last = time;
  }
  return pieces.filter(({ length }) => length >= shortestPiece);
}

/** What was measured of one recording. */
interface MeasuredRecording {
  readonly frames: number;
  readonly seconds: number;
  readonly estimators: Record<MeasuredMethod, Report>;
}

/**
 * Every method against the device's body. Throws a sentence where the recording has none, or no measures of its person.
 */
async function measureRecording(
  recording: Recording,
  regressors: ReadonlyMap<MeasuredMethod, PoseRegressor>,
): Promise<MeasuredRecording> {
  const { calibration, rateHz } = recording;
  const pieces = piecesOf(recording);
  if (pieces.length === 0) throw new Error('it has no body of the device to be compared with (docs/accuracy.md)');
  if (!calibration) throw new Error('it does not say the measures of its person');
  const estimators: Partial<Record<MeasuredMethod, Report>> = {};
  for (const name of measuredMethods) {
    const measures = emptyMeasures();
    for (const piece of pieces)
      addClip(measures, await drive(name, calibration, regressors.get(name) ?? null, piece), rateHz);
    estimators[name] = report(measures);
  }
  const frames = pieces.reduce((sum, { length }) => sum + length, 0);
  const seconds = pieces.reduce((sum, piece) => sum + piece.at(-1)!.frame.time - piece[0]!.frame.time, 0);
  return { frames, seconds, estimators: estimators as Record<MeasuredMethod, Report> };
}

const {
  recording: files,
  models,
  json,
} = JSON.parse(process.argv[2] ?? '') as {
  readonly recording: readonly string[];
  readonly models: string;
  readonly json?: string;
};
const regressors = await loadRegressors(models);
const measured: Record<string, MeasuredRecording> = {};
for (const file of files) {
  try {
    if (!existsSync(file)) throw new Error('there is no such file');
    const recording = parseRecording(readFileSync(file, 'utf8'));
    const result = await measureRecording(recording, regressors);
    measured[basename(file)] = result;
    const about = `${result.frames} frames, ${result.seconds.toFixed(1)} s of ${recording.device}`;
    printReports(`${basename(file)}: ${about}, against the device's own body`, result.estimators);
  } catch (error) {
    console.error(`${file}: ${reasonOf(error)}`);
    process.exitCode = 1;
  }
}
for (const regressor of regressors.values()) await regressor.dispose();
if (json) writeFileSync(json, `${JSON.stringify({ recordings: measured }, null, 2)}\n`);
