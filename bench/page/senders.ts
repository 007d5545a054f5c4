import { defaultCalibration } from 'threepoint/core/body/calibration';
import { relaxedHand } from 'threepoint/core/body/hand-shape';
import { skeletonFromCalibration } from 'threepoint/core/body/skeleton';
import { createEstimator } from 'threepoint/core/estimation/estimators';
import { actorFrame } from 'threepoint/core/tracking/actor-motion';
import { packetMs } from 'threepoint-rooms/protocol/packet-time';
import { encodePose } from 'threepoint-rooms/protocol/pose-codec';

/** What others send: the actor's performance, each at another place of it, as packets. */
export function createSenders(count: number) {
  const skeleton = skeletonFromCalibration(defaultCalibration);
  const senders = Array.from({ length: count }, (_, index) => ({
    seat: index + 1,
    estimator: createEstimator('ik', defaultCalibration),
    shift: 2.7 * index,
  }));
  return {
    count,
    packetsAt: (time: number) =>
      senders.map(({ seat, estimator, shift }) => {
        const frame = actorFrame(time + shift, defaultCalibration);
        const bytes = encodePose(
          {
            timeMs: packetMs(time * 1000),
            jump: false,
            pose: estimator.update(frame).pose,
            fingers: { left: relaxedHand, right: relaxedHand },
          },
          skeleton,
        );
        if (!bytes) throw new Error('a pose of the actor does not fit into a packet');
        return { seat, bytes };
      }),
  };
}
