import { pinchHandPose } from 'iwer/lib/device/configs/hand/pinch.js';
import { pointHandPose } from 'iwer/lib/device/configs/hand/point.js';
import { relaxedHandPose } from 'iwer/lib/device/configs/hand/relaxed.js';
import { type Pose, transformPoint, transformPose, untransformPoint } from '../../../src/threepoint/core/math/pose';
import { conjugate, fromAxes, multiply, type Quat, slerp } from '../../../src/threepoint/core/math/quat';
import type { Side } from '../../../src/threepoint/core/math/side';
import { lerp, vec3 } from '../../../src/threepoint/core/math/vec3';
import { controller, type Input } from './fake-headset';

type Place = Pose<'floor'>;

/** A joint of a recorded hand, in the frame of its wrist. */
interface RecordedJoint extends Place {
  readonly radius: number;
}

export type RecordedHand = ReadonlyMap<string, RecordedJoint>;

const poseOfMatrix = (m: readonly number[]): Place => ({
  orientation: fromAxes(vec3(m[0]!, m[1]!, m[2]!), vec3(m[4]!, m[5]!, m[6]!), vec3(m[8]!, m[9]!, m[10]!)),
  position: vec3(m[12]!, m[13]!, m[14]!),
});

/** A left hand that Meta recorded for its emulator, every joint against the wrist. */
function recorded(source: typeof relaxedHandPose): RecordedHand {
  const joints = Object.entries(source.jointTransforms);
  const wrist = poseOfMatrix(Object.values(source.jointTransforms.wrist.offsetMatrix));
  return new Map(
    joints.map(([name, { offsetMatrix, radius }]) => {
      const { position, orientation } = poseOfMatrix(Object.values(offsetMatrix));
      return [
        name,
        {
          position: untransformPoint<'floor', 'floor'>(wrist, position),
          orientation: multiply(conjugate(wrist.orientation), orientation),
          radius,
        },
      ];
    }),
  );
}

const relaxed = recorded(relaxedHandPose);
const pinched = recorded(pinchHandPose);
const pointing = recorded(pointHandPose);

/** The joint that a joint hangs from: the one before it of the same finger. */
const parentOf = (name: string, names: readonly string[]): string => {
  const before = names[names.indexOf(name) - 1] ?? 'wrist';
  return before.split('-')[0] === name.split('-')[0] ? before : 'wrist';
};

/** On the way from one hand to another: every joint turns, and the bones keep their lengths. */
function between(a: RecordedHand, b: RecordedHand, share: number): RecordedHand {
  const names = [...a.keys()];
  const hand = new Map<string, RecordedJoint>([['wrist', a.get('wrist')!]]);
  for (const name of names.slice(1)) {
    const parent = parentOf(name, names);
    const bone = (of: RecordedHand) => untransformPoint<'floor', 'floor'>(of.get(parent)!, of.get(name)!.position);
    const turned = (of: RecordedHand) => multiply(conjugate(of.get(parent)!.orientation), of.get(name)!.orientation);
    hand.set(name, {
      position: transformPoint<'floor', 'floor'>(hand.get(parent)!, lerp(bone(a), bone(b), share)),
      orientation: multiply(hand.get(parent)!.orientation, slerp(turned(a), turned(b), share)),
      radius: a.get(name)!.radius,
    });
  }
  return hand;
}

/** Left hands: the three recorded ones, and some on the way between them. */
export const recordedHands: Readonly<Record<string, RecordedHand>> = {
  'at ease': relaxed,
  pinched,
  pointing,
  'half pinched': between(relaxed, pinched, 0.5),
  'almost pinched': between(relaxed, pinched, 0.85),
  'half pointing': between(relaxed, pointing, 0.5),
  'from pointing to pinching': between(pointing, pinched, 0.5),
};

const mirrored = ({ position: p, orientation: o }: Place): Place => ({
  position: vec3(-p.x, p.y, p.z),
  orientation: { x: o.x, y: -o.y, z: -o.z, w: o.w } satisfies Quat,
});

/** Returns a joint of that hand for this wrist; a right hand is the mirror image. */
export function jointAt(
  hand: RecordedHand,
  name: string,
  side: Side,
  wrist: Place,
): Place & { readonly radius: number } {
  const joint = hand.get(name)!;
  return {
    ...transformPose<'floor', 'floor'>(wrist, side === 'left' ? joint : mirrored(joint)),
    radius: joint.radius,
  };
}

/** An input source of a headset that sees that hand. */
export function trackedHand(
  side: Side,
  wrist: Place,
  hand: RecordedHand,
): Input & { hand: NonNullable<Input['hand']> } {
  const joints = [...hand.keys()].map((name) => [name, { at: jointAt(hand, name, side, wrist) }] as const);
  return { ...controller(side, wrist), hand: new Map(joints) };
}
