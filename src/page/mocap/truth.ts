import { type MocapClip, mocapRateHz, type TruthJoint, truthJoints } from 'threepoint/internal';
import { type MutableVec3, setVec3, type Vec3, vec3 } from 'threepoint/math';

const width = 3 * truthJoints.length;

/** The true positions of a person's joints, floor frame [m]. */
export class Truth {
  readonly joints: readonly TruthJoint[];
  readonly frameCount: number;
  readonly #numbers: Float32Array;
  readonly #places: Partial<Record<TruthJoint, MutableVec3>> = {};

  constructor({ truth, frameCount }: MocapClip) {
    this.#numbers = truth;
    this.frameCount = frameCount;
    this.joints = truthJoints.filter((_, i) => Number.isFinite(truth[3 * i]));
    for (const joint of this.joints) this.#places[joint] = vec3(0, 0, 0);
  }

  /** Returns the positions at a time of the clip [s], interpolated. Every call returns the same object. */
  at(seconds: number): Readonly<Partial<Record<TruthJoint, Vec3>>> {
    const time = Math.max(0, Math.min(this.frameCount - 1, seconds * mocapRateHz));
    const before = Math.floor(time);
    const share = time - before;
    const [from, to] = [width * before, width * Math.min(before + 1, this.frameCount - 1)];
    for (let i = 0; i < truthJoints.length; i++) {
      const place = this.#places[truthJoints[i]!];
      if (!place) continue;
      const mix = (axis: number): number => {
        const value = this.#numbers[from + 3 * i + axis]!;
        return value + (this.#numbers[to + 3 * i + axis]! - value) * share;
      };
      setVec3(place, mix(0), mix(1), mix(2));
    }
    return this.#places;
  }
}
