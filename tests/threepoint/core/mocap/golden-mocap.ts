import { readFileSync } from 'node:fs';
import { type MocapClip, type MocapSource, prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../../../src/threepoint/core/motion/work';

/** A file of a generated person, and what the evaluation makes of it. */
export interface GoldenMocap {
  readonly motion: string;
  readonly files: Readonly<Record<string, string>>;
  readonly columns: readonly string[];
  readonly stride: number;
  readonly clips: readonly {
    readonly name: string;
    readonly frames: number;
    readonly calibration: { readonly eyeHeight: number; readonly armSpan: number };
    /** Every nth frame. */
    readonly rows: readonly (readonly number[])[];
  }[];
}

export const goldenMocap: readonly GoldenMocap[] = JSON.parse(
  readFileSync(new URL('../../../golden/mocap.json', import.meta.url), 'utf8'),
);

/** The file as the page opens it. */
export function sourceOf({ motion, files }: Pick<GoldenMocap, 'motion' | 'files'>): MocapSource {
  const text = files[motion]!;
  const map = files['map.json'];
  if (motion.endsWith('.bvh'))
    return { format: 'bvh', name: motion, text, ...(map !== undefined && { map: { name: 'map.json', text: map } }) };
  const skeleton = Object.keys(files).find((name) => name.endsWith('.asf'))!;
  return { format: 'amc', name: motion, text, skeleton: { name: skeleton, text: files[skeleton]! } };
}

/** Returns the motion in the file, and what the trackers would have reported of it. */
export const clipOf = (golden: GoldenMocap): MocapClip => finishWork(prepareMocap(sourceOf(golden))).clips[0]!;
