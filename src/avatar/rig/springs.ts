import type { VRM } from '@pixiv/three-vrm';
import type { Object3D } from 'three';
import { angleBetween, copyQuat, type Quat, quat } from '../../core/math/quat';
import { copyVec3, distance, type Vec3, vec3 } from '../../core/math/vec3';

/** Hair and skirts are moved so often [s]: what they hang on moves in every frame, and they with it. */
const stepSeconds = 1 / 30;
/** VRM's drag is a share of each step, and files are made for 60 steps a second. */
const authoredSteps = 60;
/** A head that is this far from where it was a frame ago [m, rad] has been carried, not moved: recentred, teleported. */
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
  readonly #position = vec3(0, 0, 0);
  readonly #orientation = quat(0, 0, 0, 1);

  constructor(vrm: VRM) {
    this.#vrm = vrm;
    this.#measures = measuresOf(vrm);
  }

  /** The rig is so many times the size of the file from now on. */
  scaleTo(factor: number): void {
    for (const measure of this.#measures) measure.scale(factor);
    this.#rest = true;
  }

  /** One frame after the bones were placed: the head's pose, floor frame, tells a body that is carried from one that moves. */
  update(root: Object3D, position: Vec3, orientation: Quat, deltaSeconds: number): void {
    const springs = this.#vrm.springBoneManager;
    if (!springs || this.#measures.length === 0) return;
    const moved = distance(position, this.#position) > carried || angleBetween(orientation, this.#orientation) > turned;
    copyVec3(position, this.#position);
    copyQuat(orientation, this.#orientation);
    if (moved || this.#rest) {
      this.#rest = false;
      this.#due = 0;
      root.updateWorldMatrix(true, true);
      springs.reset();
      return;
    }
    this.#due += deltaSeconds;
    if (this.#due < stepSeconds) return;
    // A pause of the page is one step: hair falls no further for it.
    this.#due = Math.min(this.#due - stepSeconds, stepSeconds);
    springs.update(stepSeconds);
  }
}
