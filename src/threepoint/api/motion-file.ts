import type { Calibration } from '../core/body/calibration';
import type { DefaultMethod, PaperMethod } from '../core/estimation/pose-estimator';
import type { Motion } from '../core/motion/motion';
import type { Work } from '../core/motion/work';
import type { BvhOptions } from '../core/motion/write-bvh';
import type { LoadNetwork } from './body';
import type { WorkOptions } from './run-work';

/** The formats that `exportMotion` writes without a MotionWriter. */
export const motionFormats = ['bvh', 'csv', 'vrma'] as const;
export type MotionFormat = (typeof motionFormats)[number];

/** An exported file in memory: `new Blob(parts, {type})`, or written part by part. */
export interface MotionFile {
  /** The file name's extension, without the dot. */
  readonly extension: string;
  readonly type: string;
  readonly parts: readonly (string | Uint8Array<ArrayBuffer>)[];
}

/** Writes motions as files of one format; `avatarMotionWriter` of threepoint/three returns another writer. */
export interface MotionWriter {
  readonly extension: string;
  readonly type: string;
  write(motion: Motion): Work<MotionFile['parts']>;
}

/** The options of an export; see `exportMotion`. */
export interface MotionFileOptions<Method extends PaperMethod = PaperMethod> extends WorkOptions, BvhOptions {
  readonly format: MotionFormat | MotionWriter;
  /** The estimator of the body between the points; default: 'learned'. */
  readonly estimator?: DefaultMethod | NoInfer<Method>;
  /** Loads the networks, as the option of a Body does. They are disposed of at the end. */
  readonly networks: LoadNetwork<Method>;
  /** The person's measures [m]. Default: the recording's, else estimated from the head height in its first frame. */
  readonly calibration?: Calibration | undefined;
}
