import { actorFrame, createEstimator, defaultCalibration, skeletonFromCalibration } from 'threepoint/core';
import { packetMs } from '../../src/rooms/protocol/packet-time';
import { encodePose } from '../../src/rooms/protocol/pose-codec';
import { relaxedHand } from '../../src/threepoint/core/body/hand-shape';

/** What others send: the actor's performance, each at another place of it, as packets. */
export function createSenders(count: number) {
  const skeleton = skeletonFromCalibration(defaultCalibration);
  const senders = Array.from({ length: count }, (_, index) => ({
    seat: index + 1,
    estimator: createEstimator('ik', defaultCalibration),
    shift: 2.7 * index,
  }));
  return {
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
