import { sideSign } from '../body/skeleton';
import { type Side, sides } from '../math/side';
import { mean } from '../math/statistics';
import { distance, dot, down, length, normalise, right, subtract, up, type Vec3, zero } from '../math/vec3';
import mocapRules from './mocap-rules.json' with { type: 'json' };
import type { MappedSkeleton, TruthJoint } from './skeleton-map';

const { eyesFromHeadJoint, shortestBone } = mocapRules;

/** The joints at rest [m], +Y up, facing −Z, without those that a file lacks. */
export type RestJoints = ReadonlyMap<TruthJoint, Vec3>;

const trunk = [
  ['hips', 'chest'],
  ['chest', 'neck'],
  ['neck', 'head'],
] as const;

/**
 * The ankle's height above the sole as a fraction of thigh and shin (Winter, Biomechanics: 0.039 and 0.491 of stature).
 */
const soleOfLeg = 0.039 / 0.491;

const between = (rest: RestJoints, a: TruthJoint, b: TruthJoint): number => distance(rest.get(a)!, rest.get(b)!);

export const armAtRest = (rest: RestJoints, side: Side): number =>
  between(rest, `${side}UpperArm`, `${side}LowerArm`) + between(rest, `${side}LowerArm`, `${side}Hand`);

/** Returns the distance from wrist to wrist with straight arms. */
export const armSpanAtRest = (rest: RestJoints): number =>
  between(rest, 'leftUpperArm', 'rightUpperArm') + armAtRest(rest, 'left') + armAtRest(rest, 'right');

/** Returns the height of the head joint above the soles, with straight legs; null: a file without legs. */
export function headHeightAtRest(rest: RestJoints): number | null {
  const legs = sides.flatMap((side) => {
    const [hip, knee, ankle] = (['UpperLeg', 'LowerLeg', 'Foot'] as const).map((part) => rest.get(`${side}${part}`));
    return hip && knee && ankle ? [distance(hip, knee) + distance(knee, ankle)] : [];
  });
  if (!rest.has('leftFoot') || legs.length === 0) return null;
  const hips = sides.flatMap((side) => rest.get(`${side}UpperLeg`)?.y ?? []);
  return (1 + soleOfLeg) * mean(legs) + rest.get('head')!.y - mean(hips);
}

/** Returns the eye height [m] with straight legs and the trunk as at rest; null: a file without legs. */
export function eyeHeightAtRest(rest: RestJoints): number | null {
  const head = headHeightAtRest(rest);
  return head === null ? null : head + eyesFromHeadJoint[1]!;
}

const direction = (v: Vec3): Vec3 => normalise(v, zero);

/** Returns a direction of a body that faces −Z in words. */
function shownVector({ x, y, z }: Vec3): string {
  const [ax, ay, az] = [Math.abs(x), Math.abs(y), Math.abs(z)];
  if (ax >= ay && ax >= az) return x > 0 ? 'to the right' : 'to the left';
  if (ay >= az) return y > 0 ? 'up' : 'down';
  return z > 0 ? 'backward' : 'forward';
}

/** Returns the unit direction from a joint at rest to another. */
const wayAtRest = (rest: RestJoints, from: TruthJoint, to: TruthJoint): Vec3 =>
  direction(subtract(rest.get(to)!, rest.get(from)!));

/**
 * Returns why an arm is not that of a T-pose, as what it does and what it should; null: it is straight, and between
 * level and hanging.
 */
export function armFault(
  rest: RestJoints,
  side: Side,
  nameOf: (joint: TruthJoint) => string = String,
): readonly [what: string, should: string] | null {
  const [shoulder, elbow, hand] = [`${side}UpperArm`, `${side}LowerArm`, `${side}Hand`] as const;
  const arm = wayAtRest(rest, shoulder, hand);
  if (dot(arm, up) > 0.5 || sideSign(side) * arm.x < -0.3)
    return [`the ${side} arm, ${nameOf(shoulder)} to ${nameOf(hand)}, points ${shownVector(arm)}`, 'sideways'];
  const folded = dot(wayAtRest(rest, shoulder, elbow), wayAtRest(rest, elbow, hand)) < 0;
  return folded ? [`the ${side} arm is folded at ${nameOf(elbow)}`, 'straight'] : null;
}

/**
 * Throws a sentence where joints at rest are no person in T-pose, with arms anywhere between level and hanging: a bone
 * of no length, a trunk that lies, shoulders that are not left and right, raised or folded arms, legs that do not
 * stand.
 */
export function checkRest(rest: RestJoints, { joints: names }: Pick<MappedSkeleton, 'joints'>): void {
  const at = (joint: TruthJoint): Vec3 => rest.get(joint)!;
  const nameOf = (joint: TruthJoint): string => names[joint] ?? 'assumed';
  const refuse = (what: string, should: string): never => {
    throw new Error(`the rest pose is no T-pose: ${what} instead of ${should}`);
  };
  const bone = (near: TruthJoint, far: TruthJoint, part: string): void => {
    if (distance(at(near), at(far)) < shortestBone)
      throw new Error(
        `${nameOf(far)} (${far}) lies on ${nameOf(near)} (${near}) in the rest pose: the file lost a bone of ${part}`,
      );
  };
  for (const [near, far] of trunk) bone(near, far, 'the trunk');
  const spine = direction(subtract(at('neck'), at('hips')));
  if (dot(spine, up) < 0.7)
    refuse(`the trunk, ${nameOf('hips')} to ${nameOf('neck')}, points ${shownVector(spine)}`, 'up');
  const across = subtract(at('rightUpperArm'), at('leftUpperArm'));
  if (dot(direction(across), right) < 0.7 || length(across) < 0.1) {
    const so = length(across) < 0.02 ? 'lie on each other' : `lie ${shownVector(across)} of each other`;
    refuse(`the shoulders, ${nameOf('leftUpperArm')} and ${nameOf('rightUpperArm')}, ${so}`, 'left and right');
  }
  for (const side of sides) {
    const [shoulder, elbow, hand] = [`${side}UpperArm`, `${side}LowerArm`, `${side}Hand`] as const;
    bone(shoulder, elbow, `the ${side} arm`);
    bone(elbow, hand, `the ${side} arm`);
    const fault = armFault(rest, side, nameOf);
    if (fault) refuse(...fault);
    const [hip, foot] = [`${side}UpperLeg`, `${side}Foot`] as const;
    if (!rest.has(hip) || !rest.has(foot)) continue;
    const leg = wayAtRest(rest, hip, foot);
    if (dot(leg, down) <= 0.7)
      refuse(`the ${side} leg, ${nameOf(hip)} to ${nameOf(foot)}, points ${shownVector(leg)}`, 'down');
  }
}
