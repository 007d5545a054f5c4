import type { Side } from '../core/body/joints';
import { clamp, dampVec3, smoothstep } from '../core/math/damper';
import { fromAxisAngle, rotate } from '../core/math/quat';
import { add, addScaled, distance, lerp, scale, subtract, up, type Vec3, vec3, zero } from '../core/math/vec3';

/** Legs are no estimate: feet stand where they were put until the pelvis has left them. All in the floor frame. */
export interface Foot {
  /** Ankle [m]; its height includes the ankle's own above the sole. */
  readonly position: Vec3;
  /** Where the toes point: yaw [rad], 0 towards −Z. */
  readonly yaw: number;
  /** Downward tilt of the toes [rad] while the foot is in the air. */
  readonly pitch: number;
  readonly planted: boolean;
}

export interface Stance {
  /** Pelvis on the floor plane and its yaw [rad]. */
  readonly pelvis: Vec3;
  readonly yaw: number;
  /** Half the distance [m] between the feet, height of an ankle above its sole, length of a leg. */
  readonly halfWidth: number;
  readonly ankleHeight: number;
  readonly legLength: number;
}

export interface Feet {
  readonly left: Foot;
  readonly right: Foot;
}

interface Step {
  readonly from: Vec3;
  readonly fromYaw: number;
  to: Vec3;
  toYaw: number;
  progress: number;
  readonly duration: number;
}

interface FootState {
  position: Vec3;
  yaw: number;
  step: Step | null;
}

export interface Stepping {
  /** Feet after `deltaSeconds` more in this stance. A jump of the pelvis takes the feet along. */
  update(stance: Stance, deltaSeconds: number): Feet;
  reset(): void;
}

/** A foot is left behind when its place is farther than this, in leg lengths, or turned by more [rad]. */
const strideShare = 0.17;
const turnLimit = 0.6;
/** Farther than this, in leg lengths, nobody steps: the person was moved. */
const jumpShare = 1.3;
/** Only who runs lifts a foot before the other is down. */
const overlapUrgency = 4;
const slowStep = 0.34;
const fastStep = 0.16;
const velocityHalfLife = 0.08;

const wrap = (angle: number): number => Math.atan2(Math.sin(angle), Math.cos(angle));

export function createStepping(): Stepping {
  let feet: Record<Side, FootState> | null = null;
  let velocity: Vec3 = zero;
  let lastPelvis: Vec3 | null = null;

  /** Where a foot belongs: beside the pelvis, toes a little out. */
  const placeOf = (side: Side, { pelvis, yaw, halfWidth, ankleHeight }: Stance): { position: Vec3; yaw: number } => {
    const sigma = side === 'left' ? -1 : 1;
    const aside = rotate(fromAxisAngle(up, yaw), vec3(sigma * halfWidth, 0, 0));
    return { position: { ...add(pelvis, aside), y: ankleHeight }, yaw: yaw - sigma * 0.12 };
  };

  function standUp(stance: Stance): Record<Side, FootState> {
    velocity = zero;
    return {
      left: { ...placeOf('left', stance), step: null },
      right: { ...placeOf('right', stance), step: null },
    };
  }

  function advance(foot: FootState, place: { position: Vec3; yaw: number }, stance: Stance, delta: number): void {
    const { step } = foot;
    if (!step) return;
    step.progress = Math.min(1, step.progress + delta / step.duration);
    // The landing place follows the pelvis for the first half of the step, then it is fixed.
    if (step.progress < 0.6) {
      const lead = scale(velocity, step.duration * (1 - step.progress) + 0.5 * step.duration);
      step.to = add(place.position, limited(lead, 0.35 * stance.legLength));
      step.toYaw = place.yaw;
    }
    const share = smoothstep(0, 1, step.progress);
    const way = distance({ ...step.from, y: 0 }, { ...step.to, y: 0 });
    const lift =
      Math.sin(Math.PI * step.progress) * clamp(0.25 * way, 0.02, 0.11) * Math.min(1, stance.legLength / 0.8);
    const ground = lerp(step.from, step.to, share);
    foot.position = vec3(ground.x, stance.ankleHeight + lift, ground.z);
    foot.yaw = step.fromYaw + wrap(step.toYaw - step.fromYaw) * share;
    if (step.progress >= 1) {
      foot.position = { ...step.to, y: stance.ankleHeight };
      foot.step = null;
    }
  }

  return {
    update(stance, deltaSeconds) {
      const pelvis = { ...stance.pelvis, y: 0 };
      if (feet && lastPelvis && distance(pelvis, lastPelvis) > 0.5 * stance.legLength) feet = null;
      if (deltaSeconds > 0 && lastPelvis) {
        velocity = dampVec3(
          velocity,
          scale(subtract(pelvis, lastPelvis), 1 / deltaSeconds),
          velocityHalfLife,
          deltaSeconds,
        );
      }
      lastPelvis = pelvis;
      feet ??= standUp(stance);
      const places = { left: placeOf('left', stance), right: placeOf('right', stance) };
      const off = (side: Side): number => {
        const foot = feet![side];
        const place = places[side];
        const ahead = addScaled(place.position, limited(velocity, 1.2), 0.12);
        const left = distance({ ...foot.position, y: 0 }, { ...ahead, y: 0 }) / (strideShare * stance.legLength);
        return Math.max(left, Math.abs(wrap(foot.yaw - place.yaw)) / turnLimit);
      };
      const far = (side: Side): boolean =>
        distance({ ...feet![side].position, y: 0 }, { ...places[side].position, y: 0 }) > jumpShare * stance.legLength;
      if (far('left') || far('right')) feet = standUp(stance);

      // One foot at a time; the one that is farther off goes first. Running overlaps: the other may start near the end.
      const urgency: Record<Side, number> = { left: off('left'), right: off('right') };
      const first: Side = urgency.left >= urgency.right ? 'left' : 'right';
      for (const side of [first, first === 'left' ? 'right' : 'left'] as const) {
        const foot = feet[side];
        const other = feet[side === 'left' ? 'right' : 'left'];
        const mayLift = other.step === null || (other.step.progress > 0.75 && urgency[side] > overlapUrgency);
        if (foot.step === null && urgency[side] > 1 && mayLift) {
          const hurry = smoothstep(1, 3, urgency[side]);
          foot.step = {
            from: foot.position,
            fromYaw: foot.yaw,
            to: places[side].position,
            toYaw: places[side].yaw,
            progress: 0,
            duration: slowStep + (fastStep - slowStep) * hurry,
          };
        }
      }
      for (const side of ['left', 'right'] as const) {
        feet[side].position = feet[side].step ? feet[side].position : { ...feet[side].position, y: stance.ankleHeight };
        advance(feet[side], places[side], stance, deltaSeconds);
      }
      const shown = (side: Side): Foot => {
        const { position, yaw, step } = feet![side];
        const pitch = step ? 0.35 * Math.sin(Math.PI * step.progress) * (step.progress < 0.5 ? 1 : -0.5) : 0;
        return { position, yaw, pitch, planted: step === null };
      };
      return { left: shown('left'), right: shown('right') };
    },
    reset() {
      feet = null;
      lastPelvis = null;
      velocity = zero;
    },
  };
}

function limited(v: Vec3, longest: number): Vec3 {
  const l = Math.hypot(v.x, v.y, v.z);
  return l > longest ? scale(v, longest / l) : v;
}
