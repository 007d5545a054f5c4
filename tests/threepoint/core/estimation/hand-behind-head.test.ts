// @module-tag full
import { type Calibration, createEstimator, type TrackingFrame } from 'threepoint/core';
import { distance, fromAxisAngle, type Side, sides, up, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import { cases } from '../../../nightly';
import { fromEulerYxz } from '../euler-angles';
import { jointsOf } from './contract-subjects';
import { poseOf } from './drawn';
import { tracked } from './moving-person';
import { openPlainModel } from './shipped-models';

const calibration: Calibration = { eyeHeight: 1.6, armSpan: 1.52 };
/** Frames per second and seconds of a path. */
const [rate, seconds] = [72, 6];
/** The first frames [s], in which a body settles. */
const settled = 0.4;
/** The largest step of an elbow beyond those of its hand and shoulder [m]. */
const mostBeyond = 0.03;
/** An arm is bent at these distances from shoulder to wrist [m]. */
const [folded, stretched] = [0.12, 0.54];

/** A random path of one hand 0.3 to 0.65 m behind the head, at ear height, turned anyhow. */
function handBehindHead(motion: number, side: Side): (time: number) => TrackingFrame {
  const random = createRandom(motion);
  const sigma = side === 'left' ? -1 : 1;
  const wave = (amplitude: number, quickest: number) => {
    const parts = [0, 1, 2].map(() => ({ rate: 1 + quickest * random(), phase: 7 * random() }));
    return (time: number) =>
      amplitude * Math.tanh(parts.reduce((sum, { rate, phase }) => sum + Math.sin(rate * time + phase), 0));
  };
  const [x, y, z, yaw, pitch, roll] = [0.25, 0.12, 0.175, 1, 0.8, 1].map((amplitude) => wave(amplitude, 5));
  const [look, nod, otherX, otherY, otherZ] = [0.3, 0.4, 0.2, 0.3, 0.25].map((amplitude) => wave(amplitude, 2));
  const held = 6 * random();
  return (time) => {
    const hand = tracked(
      vec3(sigma * 0.15 + x!(time), 1.52 + y!(time), 0.475 + z!(time)),
      fromEulerYxz(vec3(pitch!(time), held + yaw!(time), roll!(time))),
    );
    const other = tracked(
      vec3(-sigma * 0.25 + otherX!(time), 1.1 + otherY!(time), -0.3 + otherZ!(time)),
      fromAxisAngle(up, 0),
    );
    const head = tracked(vec3(0, 1.6, 0), fromEulerYxz(vec3(nod!(time), look!(time), 0)));
    return { time, head, leftHand: side === 'left' ? hand : other, rightHand: side === 'right' ? hand : other };
  };
}

test.each(['ik', 'learned'] as const)('an elbow leaps no further than its hand behind the head: %s', (name) => {
  const network = name === 'learned' ? openPlainModel() : null;
  let bent = 0;
  for (let motion = 0; motion < cases(20); motion++) {
    const side = sides[motion % 2]!;
    const at = handBehindHead(motion, side);
    const estimator = createEstimator(name, calibration, network);
    const placesOf = (time: number) => {
      const joints = jointsOf(poseOf(estimator, at(time)), calibration);
      const [elbow, shoulder, hand] = (['LowerArm', 'UpperArm', 'Hand'] as const).map(
        (part) => joints[`${side}${part}`].position,
      );
      return { elbow: elbow!, shoulder: shoulder!, hand: hand! };
    };
    let before = placesOf(0);
    for (let i = 1; i < seconds * rate; i++) {
      const now = placesOf(i / rate);
      const span = distance(now.shoulder, now.hand);
      if (i > settled * rate && span > folded && span < stretched) {
        bent += 1;
        const step = (joint: keyof typeof now) => distance(now[joint], before[joint]);
        expect(step('elbow')).toBeLessThan(step('hand') + step('shoulder') + mostBeyond);
      }
      before = now;
    }
  }
  expect(bent).toBeGreaterThan(1000);
});
