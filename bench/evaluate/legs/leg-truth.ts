import {
  cross,
  fromAxes,
  normalise,
  type Pose,
  quat,
  reject,
  type Side,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { openClip, type RecordingIndex } from '../recordings';

const legJointNames = ['UpperLeg', 'LowerLeg', 'Foot', 'Toes'] as const;

/**
 * One true leg, floor frame [m]: joints as the corpus has them; toes are where the toes begin, the ball of the foot.
 */
export interface TrueLeg {
  readonly hip: Vec3;
  readonly knee: Vec3;
  readonly ankle: Vec3;
  readonly ball: Vec3;
}

export interface TrueLegs {
  readonly hips: Pose<'floor'>;
  readonly left: TrueLeg;
  readonly right: TrueLeg;
}

/** Clip by clip; null where the recording has no legs. */
export function readLegs(
  folder: string,
  index: RecordingIndex,
  clip: RecordingIndex['clips'][number],
): TrueLegs[] | null {
  const { point, frames } = openClip(folder, index, clip);
  if (!index.columns.includes('truth.leftFoot.x')) return null;
  const joint = (name: string) => point(`truth.${name}`);
  const legOf = (side: Side) => {
    const [hip, knee, ankle, ball] = legJointNames.map((name) => joint(`${side}${name}`));
    return (row: number): TrueLeg => ({ hip: hip!(row), knee: knee!(row), ankle: ankle!(row), ball: ball!(row) });
  };
  const [left, right, hips, chest] = [legOf('left'), legOf('right'), joint('hips'), joint('chest')];
  const legs = Array.from({ length: frames }, (_, row) => {
    const [l, r] = [left(row), right(row)];
    return { hips: pelvisPose(hips(row), chest(row), l.hip, r.hip), left: l, right: r };
  });
  const whole = legs.every(({ left, right }) => Number.isFinite(left.ball.x + right.ball.x + left.hip.x + right.hip.x));
  return whole ? legs : null;
}

/** Turned as the line between the hip joints and the lower back say; identity is upright, facing −Z. */
function pelvisPose(hips: Vec3, chest: Vec3, left: Vec3, right: Vec3): Pose<'floor'> {
  const x = normalise(subtract(right, left));
  const y = normalise(reject(subtract(chest, hips), x));
  return { position: hips, orientation: fromAxes(x, y, cross(x, y, vec3(0, 0, 0)), quat(0, 0, 0, 1)) };
}

/** Which feet stand on the floor in each frame. */
export interface Contact {
  readonly left: boolean;
  readonly right: boolean;
}

/**
 * A joint of a foot that stands is no higher than this over where that person's usually is [m], and slower than this
 * [m/s].
 */
const standingHeight = 0.03;
const standingSpeed = 0.25;

/** Heights [m] at which ankle and ball of a person's feet lie while they stand. */
export interface FootHeights {
  readonly ankle: number;
  readonly ball: number;
}

/** The tenth percentile over all of a person's frames: feet are on the floor for longer than that. */
export function footHeights(clips: readonly (readonly TrueLegs[])[]): FootHeights {
  const lowest = (of: (leg: TrueLeg) => number): number => {
    const heights = clips.flatMap((frames) => frames.map(({ left, right }) => Math.min(of(left), of(right))));
    heights.sort((a, b) => a - b);
    return heights[Math.floor(heights.length / 10)] ?? 0;
  };
  return { ankle: lowest(({ ankle }) => ankle.y), ball: lowest(({ ball }) => ball.y) };
}

const speed = (a: Vec3, b: Vec3, seconds: number): number => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z) / seconds;

/** Ankle or ball low and at rest: the foot stands, flat, on its heel or on its toes. */
export function contactsOf(frames: readonly TrueLegs[], heights: FootHeights, rateHz: number): Contact[] {
  return frames.map((frame, row) => {
    const before = frames[Math.max(0, row - 1)] ?? frame;
    const after = frames[Math.min(frames.length - 1, row + 1)] ?? frame;
    const seconds = Math.max(1, Math.min(frames.length - 1, row + 1) - Math.max(0, row - 1)) / rateHz;
    const stands = (side: Side): boolean =>
      (['ankle', 'ball'] as const).some(
        (joint) =>
          frame[side][joint].y < heights[joint] + standingHeight &&
          speed(before[side][joint], after[side][joint], seconds) < standingSpeed,
      );
    return { left: stands('left'), right: stands('right') };
  });
}
