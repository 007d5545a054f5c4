import type { Recording } from '../core/tracking/recording';
import type { BareExportOptions, MotionFile } from './bare-export';
import { learnedAlone } from './load-learned';

export type ExportOptions = Omit<BareExportOptions, 'networks'> & Partial<Pick<BareExportOptions, 'networks'>>;

/**
 * A file of what a method draws of a recording, with fingers: BVH, a table of joints (CSV), VRM Animation, or what a writer makes; the networks as
 * of a Body. Rejects with a sentence where the method draws no body or fails, or no network comes; with the signal's reason where it is given up.
 */
export async function exportMotion(recording: Recording, options: ExportOptions): Promise<MotionFile> {
  // Pages that export nothing load none of it.
  const { exportMotionBare } = await import('./bare-export');
  return exportMotionBare(recording, { ...options, networks: options.networks ?? learnedAlone });
}
