import type { BoneMap, FileBones } from 'threepoint/core';

/** The skeleton of an avatar or a motion whose bones the user maps: the match failed or is wrong. */
export interface SkeletonToMap extends Pick<FileBones, 'joints' | 'confidence'> {
  readonly name: string;
  /** The matched bones, or the user's last map. */
  readonly bones: BoneMap;
  /** A sentence about a fault of the user's map; null: no fault, or no map yet. */
  readonly complaint: string | null;
  readonly isShown: boolean;
  /** Whether the bones are the user's map, which can be forgotten. */
  readonly canForgetMap: boolean;
}
