import { defaultCalibration } from '../../src/core/body/calibration';
import { relaxedHand } from '../../src/core/body/hand-shape';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { createEstimator } from '../../src/core/estimation/estimators';
import { packetMs } from '../../src/core/protocol/packet-time';
import { encodePose } from '../../src/core/protocol/pose-codec';
import { actorFrame } from '../../src/core/tracking/actor-motion';

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
