import type { Recording } from '../core/tracking/recording';
import { assertOptions, optionNames } from './assert-options';
import { loadWithoutRuntime } from './load-learned';
import type { MotionFile, MotionFileOptions } from './motion-file';

export type ExportMotionOptions = Omit<MotionFileOptions, 'networks'> & Partial<Pick<MotionFileOptions, 'networks'>>;

const exportOptions = optionNames<ExportMotionOptions>({
  format: true,
  estimator: true,
  networks: true,
  calibration: true,
  unit: true,
  rateHz: true,
  onProgress: true,
  signal: true,
});

/**
 * Returns a file of what an estimator draws of a recording, with fingers: BVH, a table of joints (CSV), VRM Animation,
 * or what a writer makes. Rejects with a sentence where the estimator draws no body or fails, or its network cannot be
 * loaded; with the signal's reason where it is cancelled.
 *
 * @example
 * const { parts, type, extension } = await exportMotion(recording, { format: 'bvh' });
 * const file = new File(parts, `motion.${extension}`, { type });
 */
export async function exportMotion(recording: Recording, options: ExportMotionOptions): Promise<MotionFile> {
  assertOptions('exportMotion', options, exportOptions);
  // Pages that export nothing load none of it.
  const { writeMotionFile: exportMotionBare } = await import('./motion-file');
  return exportMotionBare(recording, { ...options, networks: options.networks ?? loadWithoutRuntime });
}
