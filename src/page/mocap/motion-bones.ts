import type { BoneMap } from 'threepoint/core/humanoid/bones';
import type { FileBones } from 'threepoint/core/humanoid/unknown-bones-error';
import type { SkeletonToMap } from '../bones/skeleton-to-map';

/** The bone maps that users gave for files, by the hashes of the files. */
export interface BoneMaps {
  readonly all: Readonly<Record<string, BoneMap>>;
  keep(hash: string, bones: BoneMap): void;
  forget(hash: string): void;
}

export interface MotionBonesOptions<Request> {
  readonly boneMaps: BoneMaps;
  /** Shows the form; null: hides it. */
  show(skeleton: SkeletonToMap | null): void;
  /** Reads the files of a request with this map; null: with what was found. */
  read(request: Request, bones: BoneMap | null): void;
}

/** Bones of a motion, and the files from which they were read. */
export interface OfferedBones<Request> extends FileBones {
  readonly name: string;
  readonly request: Request;
  /** The hash by which a map is kept; null: it is not kept. */
  readonly hash: string | null;
  /** Whether the motion is shown. */
  readonly isShown: boolean;
  /** Whether the bones are the user's map. */
  readonly isOwnMap: boolean;
}

/** Lets the user map the bones of a motion, and keeps the map for its file. */
export class MotionBones<Request> {
  readonly #options: MotionBonesOptions<Request>;
  #offered: OfferedBones<Request> | null = null;
  #skeleton: SkeletonToMap | null = null;

  constructor(options: MotionBonesOptions<Request>) {
    this.#options = options;
  }

  /** Opens the form for the bones of a motion. */
  offer(offered: OfferedBones<Request>): void {
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
  give(bones: BoneMap | null): void {
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
