import type { Recording } from '../core/tracking/recording';
import { demandOptions, optionNames } from './demand-options';
import { learnedAlone } from './load-learned';
import type { MotionExportOptions, MotionFile } from './motion-export';

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
 * A file of what a method draws of a recording, with fingers: BVH, a table of joints (CSV), VRM Animation, or what a
 * writer makes; the networks as of a Body. Rejects with a sentence where the method draws no body or fails, or no
 * network comes; with the signal's reason where it is given up.
 */
export async function exportMotion(recording: Recording, options: ExportOptions): Promise<MotionFile> {
  demandOptions('exportMotion', options, exportOptions);
  // Pages that export nothing load none of it.
  const { exportMotionWith: exportMotionBare } = await import('./motion-export');
  return exportMotionBare(recording, { ...options, networks: options.networks ?? learnedAlone });
}
