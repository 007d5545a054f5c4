import type { VRM } from '@pixiv/three-vrm';
import { type Object3D, Quaternion, Vector3 } from 'three';
import type { Quat } from '../../core/math/quat';
import type { Vec3 } from '../../core/math/vec3';

/** The time step of hair and skirts [s]; the bones that carry them move in every frame. */
const stepSeconds = 1 / 30;
/** The maximum number of steps in one frame: on a slow page hair moves slower, and a pause adds no motion. */
const maxSteps = 2;
/** VRM's drag is a fraction per step, and files are made for 60 steps a second. */
const authoredSteps = 60;
/** The largest motion of a head in the world in one frame [m, rad]; a larger one is a teleport or recentring. */
const carried = 0.35;
const turned = 0.9;

/** A size of a joint or collider that depends on the scale of the rig. */
interface ScaledSize {
  scale(factor: number): void;
}

/** Returns the sizes that springs store as numbers, to which the rig's scale must be applied. */
function scaledSizesOf(vrm: VRM): ScaledSize[] {
  const measures: ScaledSize[] = [];
  for (const { settings } of vrm.springBoneManager?.joints ?? []) {
    const { hitRadius, stiffness, gravityPower, dragForce } = settings;
    // A step of double length keeps as much of the speed as two steps.
    settings.dragForce = 1 - (1 - dragForce) ** (authoredSteps * stepSeconds);
    measures.push({
      scale(factor) {
        settings.hitRadius = hitRadius * factor;
        settings.stiffness = stiffness * factor;
        settings.gravityPower = gravityPower * factor;
      },
    });
  }
  for (const { shape } of vrm.springBoneManager?.colliders ?? []) {
    const sized = shape as { radius?: number };
    const { radius } = sized;
    if (radius === undefined) continue;
    measures.push({
      scale(factor) {
        sized.radius = radius * factor;
      },
    });
  }
  return measures;
}

/** Simulates the spring bones of a VRM: hair, skirts, tails. */
export class Springs {
  readonly #vrm: VRM;
  readonly #measures: readonly ScaledSize[];
  /** The simulated time that is due [s]. */
  #due = 0;
  /** Whether the next frame starts from rest, after a change of size or at first. */
  #rest = true;
  /** The head's pose in the world in the previous frame. */
  readonly #position = new Vector3();
  readonly #orientation = new Quaternion();

  constructor(vrm: VRM) {
    this.#vrm = vrm;
    this.#measures = scaledSizesOf(vrm);
  }

  /** Sets the scale of the rig relative to the file. */
  scaleTo(factor: number): void {
    for (const measure of this.#measures) measure.scale(factor);
    this.#rest = true;
  }

  /**
   * Advances the springs by one frame after the bones were placed. The head's place in the world, floor frame,
   * distinguishes a carried body from a moving one.
   */
  update(root: Object3D, position: Vec3, orientation: Quat, deltaSeconds: number): void {
    const springs = this.#vrm.springBoneManager;
    if (!springs || this.#measures.length === 0) return;
    const moved = this.#wasCarried(root, position, orientation);
    if (moved || this.#rest) {
      this.#rest = false;
      this.#due = 0;
      root.updateWorldMatrix(false, true);
      springs.reset();
      return;
    }
    this.#due = Math.min(this.#due + deltaSeconds, (maxSteps + 1) * stepSeconds);
    for (let step = 0; step < maxSteps && this.#due >= stepSeconds; step++) {
      this.#due -= stepSeconds;
      springs.update(stepSeconds);
    }
  }

  /** Returns whether the head moved further since the last frame than a person can. */
  #wasCarried(root: Object3D, position: Vec3, orientation: Quat): boolean {
    root.updateWorldMatrix(true, false);
    root.matrixWorld.decompose(place, facing, scaling);
    head.copy(position).applyMatrix4(root.matrixWorld);
    facing.multiply(headFacing.copy(orientation));
    const moved = head.distanceTo(this.#position) > carried || facing.angleTo(this.#orientation) > turned;
    this.#position.copy(head);
    this.#orientation.copy(facing);
    return moved;
  }
}

const head = new Vector3();
const headFacing = new Quaternion();
const place = new Vector3();
const facing = new Quaternion();
const scaling = new Vector3();
