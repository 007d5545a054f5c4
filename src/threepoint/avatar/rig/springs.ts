import type { VRM } from '@pixiv/three-vrm';
import { type Object3D, Quaternion, Vector3 } from 'three';
import type { Quat } from '../../core/math/quat';
import type { Vec3 } from '../../core/math/vec3';

/** Hair and skirts are moved so often [s]: what they hang on moves in every frame, and they with it. */
const stepSeconds = 1 / 30;
/**
 * In one frame so often at most, one more being left for the next: slower pages have slower hair, and after a pause it
 * falls no further.
 */
const mostSteps = 2;
/** VRM's drag is a share of each step, and files are made for 60 steps a second. */
const authoredSteps = 60;
/**
 * A head that is this far from where it was in the world a frame ago [m, rad] has been carried, not moved: recentred,
 * teleported.
 */
const carried = 0.35;
const turned = 0.9;

/** What a joint or a collider was made for, in the size that the file has. */
interface Measure {
  scale(factor: number): void;
}

/** Sizes that springs have as plain numbers; the rig's scale does not reach them by itself. */
function measuresOf(vrm: VRM): Measure[] {
  const measures: Measure[] = [];
  for (const { settings } of vrm.springBoneManager?.joints ?? []) {
    const { hitRadius, stiffness, gravityPower, dragForce } = settings;
    // Twice the time in one step: what stays of the speed is what two steps would leave.
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

/** What hangs and swings on a VRM: hair, skirts, tails. */
export class Springs {
  readonly #vrm: VRM;
  readonly #measures: readonly Measure[];
  /** Time that no step has used up yet [s]. */
  #due = 0;
  /** The next frame begins from rest: another size, or none before. */
  #rest = true;
  /** The head in the world, a frame ago. */
  readonly #position = new Vector3();
  readonly #orientation = new Quaternion();

  constructor(vrm: VRM) {
    this.#vrm = vrm;
    this.#measures = measuresOf(vrm);
  }

  /** The rig is so many times the size of the file from now on. */
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
    this.#due = Math.min(this.#due + deltaSeconds, (mostSteps + 1) * stepSeconds);
    for (let step = 0; step < mostSteps && this.#due >= stepSeconds; step++) {
      this.#due -= stepSeconds;
      springs.update(stepSeconds);
    }
  }

  /** Whether the head went further since the last frame than heads go. */
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
