import { existsSync, readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { ValidationError } from 'threepoint/core';
import { type HeadsetReport, readHeadsetReport } from '../../src/page/check/headset-report';
import { type DeviceTracking, type LossQuantile, type TrackerNoise, usualTracking } from './disturbances';

/** Fewer losses than this say little about their lengths. */
const fewestLosses = 5;
/** A loss lasts at least one frame of the fastest headset [s]. */
const shortestLoss = 1 / 120;

/** Reads the file of a headset check. Throws a ValidationError that names the file, the field and the fault. */
export function readCheckFile(file: string): HeadsetReport {
  if (!existsSync(file)) throw new ValidationError('', 'there is no such file', file);
  try {
    return readHeadsetReport(readFileSync(file, 'utf8'));
  } catch (error) {
    if (error instanceof ValidationError) throw new ValidationError(error.field, error.complaint, file);
    throw error;
  }
}

/** The tracking that a headset check measured, and what its file lacks, in sentences. */
export interface CheckedTracking extends DeviceTracking {
  readonly remarks: readonly string[];
}

/**
 * Returns noise and losses of a headset check for the evaluation. The noise is that from frame to frame; both hands
 * share one figure. Throws a ValidationError where head or hands were not measured.
 */
export function trackingOf(report: HeadsetReport, file: string): CheckedTracking {
  const head = noiseOf(report, ['head']);
  const hands = noiseOf(report, ['left', 'right']);
  if (!head || !hands)
    throw new ValidationError('noise', `expected the head and a hand, found no ${head ? 'hand' : 'head'}`, file);
  const measured = lossesOf(report);
  const count = report.losses.reduce((sum, { lengthsMs }) => sum + lengthsMs.length, 0);
  return {
    name: `${basename(file)} noise`,
    noise: { head, hands },
    losses: measured ?? usualTracking.losses,
    remarks: measured ? [] : [`${file} has ${count} losses, ${fewestLosses} are needed: the usual losses are used.`],
  };
}

/** Returns the root mean square of the noise of these trackers; null: none of them was measured. */
function noiseOf(report: HeadsetReport, trackers: readonly string[]): TrackerNoise | null {
  const measured = report.noise.filter(({ tracker }) => trackers.includes(tracker));
  if (measured.length === 0) return null;
  const mean = (values: readonly number[]) =>
    Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);
  return {
    metres: mean(measured.map(({ positionMm }) => positionMm.frame)) / 1000,
    radians: (mean(measured.map(({ rotationDegrees }) => rotationDegrees.frame)) * Math.PI) / 180,
  };
}

/** Returns each loss of both hands as a quantile; null: there are too few. */
function lossesOf(report: HeadsetReport): readonly LossQuantile[] | null {
  const lengths = report.losses.flatMap(({ lengthsMs }) => lengthsMs).sort((a, b) => a - b);
  if (lengths.length < fewestLosses) return null;
  return lengths.map((ms, index) => ({
    share: index / (lengths.length - 1),
    seconds: Math.max(shortestLoss, ms / 1000),
  }));
}
