import type { Replayable } from '../core/tracking/recording';
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
 * Exports the motion that an estimator makes of a recording, with fingers: as BVH, a table of joints (CSV), VRM
 * Animation, or the format of a writer. Rejects with an Error if the estimator has no body or fails, or its network
 * cannot be loaded; with the signal's reason if it is aborted.
 *
 * @example
 * const { parts, type, extension } = await exportMotion(recording, { format: 'bvh' });
 * const file = new File(parts, `motion.${extension}`, { type });
 */
export async function exportMotion(recording: Replayable, options: ExportMotionOptions): Promise<MotionFile> {
  assertOptions('exportMotion', options, exportOptions);
  // Loaded on demand: pages that export nothing do not load the writers.
  const { writeMotionFile } = await import('./write-motion-file');
  return writeMotionFile(recording, { ...options, networks: options.networks ?? loadWithoutRuntime });
}
