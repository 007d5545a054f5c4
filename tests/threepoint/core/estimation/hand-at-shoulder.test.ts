import { type Calibration, createEstimator, type TrackingFrame } from 'threepoint/core';
import { distance, fromAxisAngle, right, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import { cases } from '../../../nightly';
import { fromEulerYxz } from '../euler-angles';
import { jointsOf } from './contract-subjects';
import { poseOf } from './drawn';
import { tracked } from './moving-person';
import { openPlainModel } from './shipped-models';

const calibration: Calibration = { eyeHeight: 1.6, armSpan: 1.55 };
const rate = 60;
const seconds = 10;
/** The largest step of an elbow beyond those of its hand and shoulder [m]: 2 m/s. */
const mostBeyond = 0.034;
/** A wrist next to the shoulder [m]. Closer to it than 5 cm a wrist would be in the flesh. */
const [nearest, farthest] = [0.05, 0.1];

/** A random path of the right hand about its shoulder. */
function handAtShoulder(motion: number): (time: number) => TrackingFrame {
  const random = createRandom(motion);
  const wave = () => {
    const parts = [1, 2, 3].map(() => ({ rate: 0.5 + 4 * random(), phase: 7 * random() }));
    return (time: number) => parts.reduce((sum, { rate, phase }) => sum + Math.sin(rate * time + phase), 0) / 2;
  };
  const [x, y, z, yaw, pitch] = [wave(), wave(), wave(), wave(), wave()];
  return (time) => ({
    time,
    head: tracked(vec3(0, 1.6, 0)),
    leftHand: tracked(vec3(-0.25, 0.8, 0), fromAxisAngle(right, -1.3)),
    rightHand: tracked(
      vec3(0.2 + 0.16 * x(time), 1.33 + 0.16 * y(time), 0.05 + 0.16 * z(time)),
      fromEulerYxz(vec3(pitch(time), yaw(time), 0)),
    ),
  });
}

test.each(['ik', 'learned'] as const)('an elbow follows a hand that passes its shoulder: %s', (name) => {
  const network = name === 'learned' ? openPlainModel() : null;
  let close = 0;
  let leaps = 0;
  for (let motion = 1; motion <= cases(20); motion++) {
    const at = handAtShoulder(motion);
    const estimator = createEstimator(name, calibration, network);
    const placesOf = (time: number) => {
      const joints = jointsOf(poseOf(estimator, at(time)), calibration);
      const [elbow, shoulder, hand] = (['LowerArm', 'UpperArm', 'Hand'] as const).map(
        (part) => joints[`right${part}`].position,
      );
      return { elbow: elbow!, shoulder: shoulder!, hand: hand!, span: distance(shoulder!, hand!) };
    };
    let before = placesOf(0);
    for (let i = 1; i < seconds * rate; i++) {
      const now = placesOf(i / rate);
      if (now.span < farthest) {
        close += 1;
        const step = (joint: 'elbow' | 'shoulder' | 'hand') => distance(now[joint], before[joint]);
        const beyond = step('elbow') - step('hand') - step('shoulder');
        if (beyond > mostBeyond) leaps += 1;
        if (Math.min(now.span, before.span) > nearest)
          expect(beyond, `motion ${motion}, frame ${i}`).toBeLessThan(mostBeyond);
      }
      before = now;
    }
  }
  expect(close).toBeGreaterThan(150);
  // In the flesh the arm has no plane that lasts: its circle turns over within a frame.
  expect(leaps / close).toBeLessThan(0.015);
});
