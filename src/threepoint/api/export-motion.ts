import type { Recording } from '../core/tracking/recording';
import { demandOptions, optionNames } from './assert-options';
import { learnedAlone } from './load-learned';
import type { MotionExportOptions, MotionFile } from './motion-file';

export type ExportOptions = Omit<MotionExportOptions, 'networks'> & Partial<Pick<MotionExportOptions, 'networks'>>;

const exportOptions = optionNames<ExportOptions>({
  to: true,
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
 * const { parts, type, extension } = await exportMotion(recording, { to: 'bvh' });
 * const file = new File(parts, `motion.${extension}`, { type });
 */
export async function exportMotion(recording: Recording, options: ExportOptions): Promise<MotionFile> {
  demandOptions('exportMotion', options, exportOptions);
  // Pages that export nothing load none of it.
  const { exportMotionWith: exportMotionBare } = await import('./motion-file');
  return exportMotionBare(recording, { ...options, networks: options.networks ?? learnedAlone });
}
