import type { BoneMap, EstimatorName, FileBones } from 'threepoint/core';
import type { SkeletonToMap } from '../bones/skeleton-to-map';
import type { MocapFile } from './mocap-files';
import type { TruthPlace } from './truth-places';

/** The bone maps that users gave for files, by the hashes of the files. */
export interface BoneMaps {
  readonly all: Readonly<Record<string, BoneMap>>;
  store(hash: string, bones: BoneMap): void;
  forget(hash: string): void;
}

/** The presentation of a clip. Absent members stay as they are. */
export interface ClipView {
  /** The index of the clip, from 0. */
  readonly clip?: number | undefined;
  /** The time at which the replay is paused [s]. */
  readonly at?: number | undefined;
  /** The estimator of the second body. */
  readonly beside?: EstimatorName | undefined;
  readonly truth?: TruthPlace | undefined;
}

export interface OpenRequest {
  readonly sources: readonly MocapFile[];
  readonly view: ClipView;
  /** Its number among the recorder's requests; absent: the newest. */
  readonly requestNumber?: number | undefined;
}

interface MotionBonesOptions {
  readonly boneMaps: BoneMaps;
  /** Shows the form; null: hides it. */
  show(skeleton: SkeletonToMap | null): void;
  /** Reads the files of a request with this map; null: with the bones that the matcher finds. */
  read(request: OpenRequest, bones: BoneMap | null): void;
}

/** Bones of a motion, and the files from which they were read. */
interface OfferedBones extends FileBones {
  readonly name: string;
  readonly request: OpenRequest;
  /** The hash by which the map is stored; null: it is not stored. */
  readonly hash: string | null;
  readonly isShown: boolean;
  readonly isOwnMap: boolean;
}

/** Lets the user map the bones of a motion, and forgets the map of its file on request. */
export class MotionBones {
  readonly #options: MotionBonesOptions;
  #offered: OfferedBones | null = null;
  #skeleton: SkeletonToMap | null = null;

  constructor(options: MotionBonesOptions) {
    this.#options = options;
  }

  /** Opens the form for the bones of a motion. */
  offer(offered: OfferedBones): void {
    const { name, joints, matched, confidence, isShown, isOwnMap } = offered;
    this.#offered = offered;
    this.#show({ name, joints, bones: matched, confidence, complaint: null, isShown, canForgetMap: isOwnMap });
  }

  /** Closes the form. */
  close(): void {
    this.#offered = null;
    this.#show(null);
  }

  /** Reads the motion with the user's map; null: forgets the map, and reads the motion with what is found. */
  apply(bones: BoneMap | null): void {
    if (!this.#offered) return;
    const { request, hash } = this.#offered;
    if (!bones && hash !== null) this.#options.boneMaps.forget(hash);
    this.#options.read(request, bones);
  }

  /** Shows why a map does not fit. */
  complain(bones: BoneMap, complaint: string): void {
    if (this.#skeleton) this.#show({ ...this.#skeleton, bones, complaint });
  }

  #show(skeleton: SkeletonToMap | null): void {
    if (skeleton === this.#skeleton) return;
    this.#skeleton = skeleton;
    this.#options.show(skeleton);
  }
}
