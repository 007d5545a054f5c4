import { type Calibration, createEstimator, type TrackingFrame } from 'threepoint/core';
import {
  distance,
  fromAxisAngle,
  lerp,
  makeTransform,
  right,
  rotate,
  smoothstep,
  subtract,
  up,
  vec3,
} from 'threepoint/math';
import { expect, test } from 'vitest';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import { cases } from '../../../nightly';
import { fromEulerYxz } from '../euler-angles';
import { jointsOf } from './contract-subjects';
import { poseOf } from './drawn';
import { tracked, transformFrame } from './moving-person';
import { openPlainModel } from './shipped-models';

/** People with forearms of the average share of their arm, of a long and of a short one. */
const people: readonly Calibration[] = [
  { eyeHeight: 1.6, armSpan: 1.55 },
  { eyeHeight: 1.6, armSpan: 1.55, forearm: 0.34 },
  { eyeHeight: 1.75, armSpan: 1.72, forearm: 0.27 },
];
const rate = 60;
const seconds = 10;
/** The largest step of an elbow beyond that of its hand [m]: 2 m/s. */
const mostBeyond = 2.001 / rate;
/** The largest one where the clavicle does not reach the upper arm's end: in less than one frame of a thousand [m]. */
const mostForced = 0.05;
/** A wrist next to the shoulder [m]. */
const close = 0.1;

/** A random path of the right hand, up to `furthest` [m] from its shoulder along each axis; a person turned anyhow. */
function handAtShoulder(motion: number, furthest: number, { eyeHeight }: Calibration): (time: number) => TrackingFrame {
  const random = createRandom(motion);
  const wave = () => {
    const parts = [1, 2, 3].map(() => ({ rate: 0.5 + 4 * random(), phase: 7 * random() }));
    return (time: number) => parts.reduce((sum, { rate, phase }) => sum + Math.sin(rate * time + phase), 0) / 2;
  };
  const [x, y, z, yaw, pitch, nod, look] = [wave(), wave(), wave(), wave(), wave(), wave(), wave()];
  const floorFromPerson = makeTransform();
  Object.assign(floorFromPerson.orientation, fromAxisAngle(up, 7 * random()));
  Object.assign(floorFromPerson.position, rotate(floorFromPerson.orientation, vec3(random(), 0, random())));
  return (time) =>
    transformFrame(floorFromPerson, {
      time,
      head: tracked(vec3(0, eyeHeight, 0), fromEulerYxz(vec3(0.1 * nod!(time), 0.1 * look!(time), 0))),
      leftHand: tracked(vec3(-0.25, 0.5 * eyeHeight, 0), fromAxisAngle(right, -1.3)),
      rightHand: tracked(
        vec3(0.2 + furthest * x!(time), 0.83 * eyeHeight + furthest * y!(time), 0.05 + furthest * z!(time)),
        fromEulerYxz(vec3(pitch!(time), yaw!(time), 0)),
      ),
    });
}

test.each(['ik', 'learned'] as const)('an elbow follows a hand that passes its shoulder: %s', (name) => {
  const network = name === 'learned' ? openPlainModel() : null;
  let frames = 0;
  let leaps = 0;
  for (let motion = 1; motion <= cases(24); motion++) {
    const calibration = people[motion % people.length]!;
    const at = handAtShoulder(motion, motion % 2 ? 0.16 : 0.06, calibration);
    const estimator = createEstimator(name, calibration, network);
    const placesOf = (time: number) => {
      const frame = at(time);
      const joints = jointsOf(poseOf(estimator, frame), calibration);
      const place = (joint: keyof typeof joints) => subtract(joints[joint].position, joints.head.position);
      return {
        elbow: place('rightLowerArm'),
        shoulder: place('rightUpperArm'),
        hand: place('rightHand'),
        off: distance(joints.rightHand.position, frame.rightHand!.position),
      };
    };
    let before = placesOf(0);
    for (let i = 1; i < seconds * rate; i++) {
      const now = placesOf(i / rate);
      const where = `motion ${motion}, frame ${i}`;
      if (distance(now.shoulder, now.hand) < close) frames += 1;
      const step = (joint: 'elbow' | 'hand') => distance(now[joint], before[joint]);
      const beyond = step('elbow') - step('hand');
      if (beyond > mostBeyond) leaps += 1;
      expect(beyond, where).toBeLessThan(mostForced);
      expect(now.off, where).toBeLessThan(0.005);
      before = now;
    }
  }
  expect(frames).toBeGreaterThan(100);
  expect(leaps).toBeLessThan((cases(24) * seconds * rate) / 1000);
});

/** A person who walks and turns without a right hand, which returns after 2 s and moves on far from its shoulder. */
function handThatReturns(motion: number): { readonly armSpan: number; readonly at: (time: number) => TrackingFrame } {
  const random = createRandom(motion);
  const about = (mean: number, spread: number) => mean + spread * (2 * random() - 1);
  const near = (x: number, y: number, z: number) => vec3(about(x, 0.05), about(y, 0.05), about(z, 0.05));
  const [from, to] = [near(0.2, 1.7, -0.85), near(-0.1, 1.3, -0.75)];
  const [turn, seconds, pitch] = [about(2.8, 0.3), about(0.5, 0.15), about(0, 0.3)];
  return {
    armSpan: about(1.55, 0.15),
    at: (time) => {
      const walked = smoothstep(1, 3, time);
      const hand = lerp(from, to, smoothstep(3, 3 + seconds, time));
      return {
        time,
        head: tracked(vec3(0.2 * walked, 1.6, -1.2 * walked), fromAxisAngle(up, turn * walked)),
        leftHand: tracked(vec3(-0.25, 0.95, -0.1), fromAxisAngle(right, -1)),
        rightHand: time > 1 && time < 3 ? null : tracked(hand, fromEulerYxz(vec3(pitch, 0, 0))),
      };
    },
  };
}

test('a shoulder does not yield to a hand that returns far from it', () => {
  const network = openPlainModel();
  for (let motion = 1; motion <= 10; motion++) {
    const { armSpan, at } = handThatReturns(motion);
    const calibration: Calibration = { eyeHeight: 1.6, armSpan };
    const estimator = createEstimator('learned', calibration, network);
    let before = vec3(0, 0, 0);
    for (let i = 0; i < 5 * rate; i++) {
      const frame = at(i / rate);
      const now = { ...jointsOf(poseOf(estimator, frame), calibration).rightUpperArm.position };
      // From here on the hand is still, and the arm moves to it.
      if (frame.time >= 3.65) expect(distance(now, before), `motion ${motion}, frame ${i}`).toBeLessThan(mostForced);
      before = now;
    }
  }
});
