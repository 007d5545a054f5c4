import { type Calibration, createEstimator, type PoseEstimator, type TrackingFrame } from 'threepoint/core';
import { distance, lerp, slerp, type TrackedPose } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import { cases } from '../../../nightly';
import { seed } from '../arbitraries';
import { jointsOf } from './contract-subjects';
import { type Joints, poseOf } from './drawn';
import { movingPerson } from './moving-person';
import { openPlainModel } from './shipped-models';

const calibration: Calibration = { eyeHeight: 1.6, armSpan: 1.58 };
/** Frames per second, and seconds of a history, of the way to the same points and of rest there. */
const [rate, historySeconds, waySeconds, restSeconds] = [30, 10, 0.7, 8];
/** The number of bodies that are led to the same points. */
const bodies = 8;
/** The largest distance of the same joint of two of them [m] at 95 % of the points. */
const mostApart = 0.005;

const standpoint = { x: 0.4, z: -0.3, yaw: 1.1 };
const between = (a: TrackedPose, b: TrackedPose, share: number): TrackedPose => ({
  position: lerp(a.position, b.position, share),
  orientation: slerp(a.orientation, b.orientation, share),
  tracking: 'tracked',
});

/** Moves as a person of this seed for some seconds, goes to the points and rests there; returns the drawn joints. */
function ledTo(points: TrackingFrame, motion: number, estimator: PoseEstimator): Joints {
  const person = movingPerson(motion, calibration, standpoint);
  const atPoints = (frame: TrackingFrame, share: number, time: number): TrackingFrame => ({
    time,
    head: between(frame.head, points.head, share),
    leftHand: between(frame.leftHand!, points.leftHand!, share),
    rightHand: between(frame.rightHand!, points.rightHand!, share),
  });
  for (let i = 0; i < (historySeconds + waySeconds + restSeconds) * rate; i++) {
    const time = i / rate;
    const share = Math.min(Math.max((time - historySeconds) / waySeconds, 0), 1);
    estimator.update(atPoints(person(Math.min(time, historySeconds)), share, time));
  }
  return jointsOf(poseOf(estimator, atPoints(points, 1, historySeconds + waySeconds + restSeconds)), calibration);
}

describe.each(['ik', 'learned'] as const)('bodies of one calibration that come to the same points: %s', (name) => {
  test('have the same elbows after ten seconds of different movements', { tags: ['full'] }, () => {
    const random = createRandom(seed);
    const network = name === 'learned' ? openPlainModel() : null;
    const apart = Array.from({ length: cases(3) }, () => {
      const points = movingPerson(Math.floor(1e6 * random()), calibration, standpoint)(20 * random());
      const drawn = Array.from({ length: bodies }, () =>
        ledTo(points, Math.floor(1e6 * random()), createEstimator(name, calibration, network)),
      );
      const joints = ['leftLowerArm', 'rightLowerArm', 'leftUpperArm', 'hips'] as const;
      return joints.map((joint) =>
        Math.max(...drawn.flatMap((a) => drawn.map((b) => distance(a[joint].position, b[joint].position)))),
      );
    }).flat();
    apart.sort((a, b) => a - b);
    expect(apart[Math.floor(0.95 * apart.length)]).toBeLessThan(mostApart);
  });
});
