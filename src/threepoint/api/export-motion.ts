import type { PaperMethod } from '../core/estimation/pose-estimator';
import type { Replayable } from '../core/tracking/recording';
import { assertOptions, optionNames } from './assert-options';
import type { MotionFile, MotionFileOptions } from './motion-file';

export interface ExportMotionOptions<Method extends PaperMethod = never>
  extends Omit<MotionFileOptions<Method>, 'networks'>,
    Partial<Pick<MotionFileOptions<Method>, 'networks'>> {}

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
export async function exportMotion<Method extends PaperMethod = never>(
  recording: Replayable,
  options: ExportMotionOptions<Method>,
): Promise<MotionFile> {
  assertOptions('exportMotion', options, exportOptions);
  // Loaded on demand: pages that export nothing load neither the writers nor a network.
  const { writeMotionFile } = await import('./write-motion-file');
  const networks = options.networks ?? (await import('./load-learned')).loadWithoutRuntime;
  return writeMotionFile(recording, { ...options, networks });
}
