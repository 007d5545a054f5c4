import type { Side } from '../body/joints';
import { sideSign } from '../body/skeleton';
import { solveTwoBones, type TwoBoneSolution } from '../body/two-bone-ik';
import { bisect } from '../math/bisection';
import { clamp, dampedShare, smoothstep } from '../math/damper';
import { between, conjugate, fromAxes, type Quat, rotate } from '../math/quat';
import {
  addScaled,
  cross,
  distance,
  dot,
  length,
  normalise,
  reject,
  right,
  scale,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../math/vec3';
import type { Arm } from './arm-way';

/** What an elbow remembers, so that it does not flip: chest frame. */
export interface ElbowSide {
  /** From the shoulder to the wrist, unit. */
  readonly axis: Vec3;
  /** Where the elbow points from that line, unit. */
  readonly pole: Vec3;
}

/** An arm as somebody estimates it, floor frame. */
export interface EstimatedArm {
  readonly shoulder: Vec3;
  readonly elbow: Vec3;
  readonly wrist: Vec3;
}

/** What an elbow keeps out of, floor frame. */
interface Trunk {
  readonly hips: Vec3;
  readonly chest: Vec3;
  readonly neck: Vec3;
  readonly rotations: { readonly upperChest: Quat };
}

/** An elbow circles the line from shoulder to wrist at most this fast [rad/s]; a punch's elbow does 10. */
const swivelSpeed = 12;
/** The same where the hand is a guess. */
const guessedSwivelSpeed = 5;
/** Longest half-life [s] of the way that an elbow follows, where its estimate says little about the side it points to. */
const unsureHalfLife = 0.35;
/** An estimated elbow nearer to the arm's line than this [m] says little: the arm is nearly straight. */
const unsurePole = 0.04;
/** A hand nearer to the shoulder than the first says nothing about the line between them, further than the second all [arm lengths]. */
const [handAtShoulder, handAway] = [0.1, 0.3];
/** The trunk as a capsule, skin and elbow included: half width, half depth, and height of the caps [share of the thorax's length]. */
const trunkHalfWidth = 1.2;
const trunkHalfDepth = 0.85;
const trunkCap = 0.5;

/**
 * The elbow of an arm whose wrist is at the target, or of a straight arm towards it, floor frame: as nearly where it is estimated as
 * the trunk and `before` (null: anywhere) let it. trust in [0, 1] of the hand: elbows of guesses turn slower.
 */
export function bendElbow(
  side: Side,
  { shoulder, upperArm, forearm }: Arm,
  target: Vec3,
  estimated: EstimatedArm,
  trunk: Trunk,
  before: ElbowSide | null,
  trust: number,
  deltaSeconds: number,
): TwoBoneSolution {
  const sigma = sideSign(side);
  const floorFromChest = trunk.rotations.upperChest;
  const downAndBack = rotate(floorFromChest, normalise(vec3(0.2 * sigma, -1, 0.5)));
  const fallbacks: [Vec3, Vec3] = [downAndBack, rotate(floorFromChest, vec3(0, 0, 1))];
  const solve = (direction: Vec3) => solveTwoBones(shoulder, target, upperArm, forearm, direction, fallbacks);
  const circle = elbowCircle(solve(downAndBack), shoulder);
  const wanted = wantedPole(estimated, circle, fallbacks);
  return solve(steadyPole(sigma, wanted, circle, trunk, before, trust, upperArm + forearm, deltaSeconds));
}

/** All places of an elbow: a circle about the line from shoulder to wrist. */
interface ElbowCircle {
  readonly centre: Vec3;
  /** From shoulder to wrist, unit. */
  readonly axis: Vec3;
  readonly radius: number;
  /** From shoulder to wrist [m], as far as the arm reaches. */
  readonly span: number;
}

function elbowCircle({ elbow, axis, pole }: TwoBoneSolution, shoulder: Vec3): ElbowCircle {
  const radius = dot(subtract(elbow, shoulder), pole);
  const centre = addScaled(elbow, pole, -radius);
  return { centre, axis, radius, span: 2 * distance(centre, shoulder) };
}

/** Where the estimated elbow points from its own arm's line, and how sure that is, in [0, 1]. */
function wantedPole(
  { shoulder, elbow, wrist }: EstimatedArm,
  { axis }: ElbowCircle,
  fallbacks: readonly [Vec3, Vec3],
): { readonly direction: Vec3; readonly sure: number } {
  const ownAxis = normalise(subtract(wrist, shoulder), axis);
  const aside = reject(subtract(elbow, shoulder), ownAxis);
  let across = reject(rotate(between(ownAxis, axis), aside), axis);
  for (const fallback of fallbacks) if (length(across) < 1e-6) across = reject(fallback, axis);
  return { direction: normalise(across), sure: smoothstep(0, unsurePole, length(aside)) };
}

/**
 * Where the elbow points now: after its estimate by way of the trunk's outside, with bounded speed, and slowly where the estimate says
 * little. The side it had is carried along as the arm moves. The first frame takes the estimate, out of the trunk.
 */
function steadyPole(
  sigma: number,
  goal: { readonly direction: Vec3; readonly sure: number },
  circle: ElbowCircle,
  trunk: Trunk,
  before: ElbowSide | null,
  trust: number,
  arm: number,
  deltaSeconds: number,
): Vec3 {
  const { axis } = circle;
  const floorFromChest = trunk.rotations.upperChest;
  // Angles about the arm's line, from the direction that leads away from the trunk.
  const outside = reject(rotate(floorFromChest, vec3(sigma, 0, 0)), axis);
  const zero = normalise(length(outside) > 1e-3 ? outside : reject(rotate(floorFromChest, vec3(0, 0, 1)), axis));
  const quarter = cross(axis, zero);
  const angleOf = (direction: Vec3): number => Math.atan2(dot(direction, quarter), dot(direction, zero));
  const poleAt = (angle: number): Vec3 => addScaled(scale(zero, Math.cos(angle)), quarter, Math.sin(angle));

  const free = freeSwivel(circle, zero, quarter, trunk);
  const estimated = angleOf(goal.direction);
  const wanted = free ? nearestWithin(estimated, free) : estimated;
  if (!before) return poleAt(wanted);

  const carried = rotate(between(rotate(floorFromChest, before.axis), axis), rotate(floorFromChest, before.pole));
  const kept = angleOf(carried);
  const inside = free !== null && nearestWithin(kept, free) !== kept;
  // Free to move both ways round, the elbow takes the shorter; else the one that does not lead through the trunk.
  const way = free && !inside ? wanted - kept : Math.atan2(Math.sin(wanted - kept), Math.cos(wanted - kept));
  const sure = goal.sure * smoothstep(handAtShoulder * arm, handAway * arm, circle.span);
  const followed = inside ? way : way * dampedShare(unsureHalfLife * (1 - sure) ** 3, deltaSeconds);
  const most = (guessedSwivelSpeed + (swivelSpeed - guessedSwivelSpeed) * trust) * Math.max(deltaSeconds, 0);
  return poleAt(kept + clamp(followed, -most, most));
}

/** The angles of a range [low, high] around 0 nearest to one in (−π, π]. */
function nearestWithin(angle: number, [low, high]: readonly [number, number]): number {
  if (angle >= low && angle <= high) return angle;
  const beyond = (from: number) => Math.abs(Math.atan2(Math.sin(angle - from), Math.cos(angle - from)));
  return beyond(low) < beyond(high) ? low : high;
}

/** Angles are looked at in steps of this [rad], borders found to a sixty-fourth of it. */
const swivelStep = Math.PI / 18;

/** The swivel angles about the outside at which an elbow is clear of the trunk; null: at all. */
function freeSwivel(
  { centre, radius }: ElbowCircle,
  zero: Vec3,
  quarter: Vec3,
  trunk: Trunk,
): readonly [number, number] | null {
  const unit = distance(trunk.neck, trunk.chest);
  const axisUp = normalise(subtract(trunk.neck, trunk.hips), up);
  const side = normalise(reject(rotate(trunk.rotations.upperChest, right), axisUp), right);
  const trunkFromFloor = conjugate(fromAxes(side, axisUp, cross(side, axisUp)));
  const height = distance(trunk.neck, trunk.hips);
  const [c, u, v] = [
    rotate(trunkFromFloor, subtract(centre, trunk.hips)),
    rotate(trunkFromFloor, scale(zero, radius)),
    rotate(trunkFromFloor, scale(quarter, radius)),
  ];
  /** Below 1 inside the trunk. */
  const clearance = (angle: number): number => {
    const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
    const y = c.y + u.y * cosine + v.y * sine;
    const x = (c.x + u.x * cosine + v.x * sine) / (trunkHalfWidth * unit);
    const z = (c.z + u.z * cosine + v.z * sine) / (trunkHalfDepth * unit);
    const beyond = (y - clamp(y, 0, height)) / (trunkCap * unit);
    return Math.sqrt(x * x + beyond * beyond + z * z);
  };
  /** From the outside on to one side: the last free angle. */
  const border = (way: number): number => {
    for (let step = 1; step <= 18; step++) {
      if (clearance(way * step * swivelStep) >= 1) continue;
      const blocked = (angle: number): boolean => clearance(way * angle) < 1;
      return way * bisect((step - 1) * swivelStep, step * swivelStep, blocked, 6)[0];
    }
    return way * Math.PI;
  };
  const high = border(1);
  const low = border(-1);
  return high === Math.PI && low === -Math.PI ? null : [low, high];
}
