import fc from 'fast-check';
import type { Calibration } from 'threepoint/core/body/calibration';
import { skeletonFromCalibration } from 'threepoint/core/body/skeleton';
import { createIk } from 'threepoint/core/estimation/estimators';
import type { PoseEstimator } from 'threepoint/core/estimation/pose-estimator';
import type { TrackedPose } from 'threepoint/core/math/pose';
import { fromAxisAngle, multiply } from 'threepoint/core/math/quat';
import { up, vec3 } from 'threepoint/core/math/vec3';
import { actorFrame } from 'threepoint/core/tracking/actor-motion';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { packetMs } from 'threepoint-rooms/protocol/packet-time';
import type { PosePacket } from 'threepoint-rooms/protocol/pose-packet';
import { evenly, rotation, standpoint, vector } from '../../threepoint/core/arbitraries';
import { show } from '../../threepoint/core/estimation/drawn';
import { movingPerson, transformFrame, withHand } from '../../threepoint/core/estimation/moving-person';

export const calibrationOf = fc
  .tuple(evenly(0.95, 2.1), evenly(0.82, 1.05))
  .map(([eyeHeight, ratio]): Calibration => ({ eyeHeight, armSpan: eyeHeight * ratio }));

/** What happens to a hand on the way to the frame that is sent. */
type Fate = 'seen' | 'lost' | 'emulated' | 'returning' | 'too far' | 'wrung';

const fate = fc.constantFrom<Fate>('seen', 'seen', 'seen', 'lost', 'emulated', 'returning', 'too far', 'wrung');

const rate = 1 / 60;
/** Frames before the one that is sent: an arm is on its way to rest, or back. */
const framesBefore = 18;

const bend = fc.record({
  knuckle: evenly(-0.3, 1.6),
  spread: evenly(-0.3, 0.9),
  middle: evenly(-0.1, 1.9),
  end: evenly(-0.1, 1.2),
});
const hand = fc.option(
  fc.record({ thumb: bend, index: bend, middle: bend, ring: bend, little: bend, pinch: evenly(0, 1) }),
  { nil: null },
);

/**
 * A person of any size anywhere, turned anyhow, in the middle of an actor's or a random movement, both hands with a
 * fate.
 */
export const senders = fc.record({
  calibration: calibrationOf,
  motion: fc.integer({ min: 1 }),
  actor: fc.boolean(),
  standpoint,
  start: evenly(0, 100),
  fates: fc.record({ left: fate, right: fate }),
  away: vector(0.9),
  turned: rotation,
  jump: fc.boolean(),
  headEmulated: fc.boolean(),
  fingers: fc.record({ left: hand, right: hand }),
});

export type Sender = typeof senders extends fc.Arbitrary<infer T> ? T : never;

/** The frames up to the one that is sent. */
export function framesOf(sender: Sender): readonly TrackingFrame[] {
  const { calibration, motion, actor, standpoint: at, start, fates, away, turned } = sender;
  const person = movingPerson(motion, calibration, at);
  const place = { position: vec3(at.x, 0, at.z), orientation: fromAxisAngle(up, at.yaw) };
  const frameAt = (time: number): TrackingFrame =>
    actor ? transformFrame(place, actorFrame(time, calibration)) : person(time);
  return Array.from({ length: framesBefore + 1 }, (_, i) => {
    let frame = frameAt(start + i * rate);
    for (const side of ['left', 'right'] as const) {
      const hand = frame[`${side}Hand`] as TrackedPose;
      const changed = {
        seen: hand,
        lost: i > 4 ? null : hand,
        emulated: i > 4 ? { ...hand, tracking: 'emulated' as const } : hand,
        returning: i > 1 && i < framesBefore - 5 ? null : hand,
        'too far': {
          ...hand,
          position: vec3(hand.position.x + away.x, hand.position.y + away.y, hand.position.z + away.z),
        },
        wrung: { ...hand, orientation: multiply(hand.orientation, turned) },
      }[fates[side]];
      frame = withHand(frame, side, changed);
    }
    return sender.headEmulated ? { ...frame, head: { ...frame.head, tracking: 'emulated' as const } } : frame;
  });
}

/** Returns the packet of a person with a body that this estimator solves (default: IK). */
export async function packetOf(
  sender: Sender,
  create: (calibration: Calibration) => PoseEstimator = createIk,
): Promise<{ packet: PosePacket; skeleton: ReturnType<typeof skeletonFromCalibration> }> {
  const estimator = create(sender.calibration);
  let pose: PosePacket['pose'] | null = null;
  for (const frame of framesOf(sender)) {
    pose = await show(estimator, frame);
  }
  return {
    packet: {
      timeMs: packetMs(sender.start * 1000),
      jump: sender.jump,
      pose: pose!,
      fingers: sender.fingers,
    },
    skeleton: skeletonFromCalibration(sender.calibration),
  };
}
