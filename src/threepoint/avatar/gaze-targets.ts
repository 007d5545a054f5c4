import { makeTransform, type Pose, type Transform, untransformPoint } from '../core/math/pose';
import { type Quat, rotateInverse } from '../core/math/quat';
import { copyVec3, length, type MutableVec3, subtract, type Vec3, vec3 } from '../core/math/vec3';

/** The angle from where a face points within which a place attracts its eyes [rad]. */
const widest = 0.55;
/** How much closer to where the face points another place must be to replace the one that eyes are on [rad]. */
const advantage = 0.1;
/** The distances of what attracts eyes [m]. Nearer ones are parts of the own head. */
const nearest = 0.15;
const farthest = 8;

interface GazeTarget {
  key: unknown;
  readonly position: MutableVec3;
}

/** The places that attract the eyes of avatars in one frame: heads, balls, a camera. */
export class GazeTargets {
  readonly #targets: GazeTarget[] = [];
  #count = 0;

  get count(): number {
    return this.#count;
  }

  at(index: number): Readonly<GazeTarget> {
    return this.#targets[index]!;
  }

  clear(): void {
    this.#count = 0;
  }

  /** Adds a place, floor frame [m], which is copied. `key`: what is there, the same in every frame. */
  add(key: unknown, position: Vec3): void {
    let target = this.#targets[this.#count];
    if (!target) {
      target = { key, position: vec3(0, 0, 0) };
      this.#targets.push(target);
    }
    target.key = key;
    copyVec3(position, target.position);
    this.#count += 1;
  }
}

const ownFloor = makeTransform<'floor', 'floor'>();
const place = vec3(0, 0, 0);
const direction = vec3(0, 0, 0);

/** Chooses what one face looks at, frame by frame. */
export class GazeChoice {
  #key: unknown = null;
  readonly #chosen = vec3(0, 0, 0);

  /**
   * Returns the target that is closest to where a face points; null: none is before the face. Eyes stay on a target
   * until another one is clearly closer, so that they do not flicker. The head's pose and the result are in the frame
   * of the person's own floor, which `placement` takes to that of the targets. The next call overwrites the result.
   */
  choose(
    targets: GazeTargets,
    { position, orientation }: Pose<'floor'>,
    placement: Transform<'floor', 'floor'> = ownFloor,
  ): Vec3 | null {
    const before = this.#key;
    let least = widest;
    this.#key = null;
    for (let i = 0; i < targets.count; i++) {
      const { key, position: target } = targets.at(i);
      untransformPoint(placement, target, place);
      const angle = angleAhead(orientation, subtract(place, position, direction)) - (key === before ? advantage : 0);
      if (!(angle < least)) continue;
      least = angle;
      this.#key = key;
      copyVec3(place, this.#chosen);
    }
    return this.#key === null ? null : this.#chosen;
  }
}

/** Returns the angle of a direction to that of a face [rad]; Infinity: too near or far away; NaN: no direction. */
function angleAhead(face: Quat, towards: Vec3): number {
  const distance = length(rotateInverse(face, towards, direction));
  if (distance < nearest || distance > farthest) return Number.POSITIVE_INFINITY;
  return Math.acos(Math.max(-1, Math.min(1, -direction.z / distance)));
}
