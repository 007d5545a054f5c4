import {
  actorFrame,
  createEstimator,
  defaultCalibration,
  forwardKinematics,
  jointNames,
  skeletonFromCalibration,
} from 'threepoint/core';
import { add, addScaled, distance, type Vec3, vec3 } from 'threepoint/math';
import { createMatch } from 'threepoint-games';
import { type BallInput, type BallState, ballRules, rackPosition } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { reportFigures } from '../reliability/report-figures';
import { poseOf } from '../threepoint/core/estimation/drawn';
import { hold, inFront, leftThrower, stand, velocityTo } from './ball/playing';

const rates = [72, 80, 90, 120] as const;
/** Returns whether a frame is dropped: 30 % are, at most two in a row. */
const dropped = (frame: number): boolean => (frame * 7) % 10 < 3;
const never = (): boolean => false;
const ways = rates.flatMap((rate) => [never, dropped].map((drop) => ({ rate, drop })));
const framesOf = (rate: number, drop: (frame: number) => boolean, seconds: number): number[] =>
  Array.from({ length: Math.round(seconds * rate) }, (_, i) => i).flatMap((i) => (drop(i) ? [] : [i / rate]));

test('balls fly the same at every rate', () => {
  const velocity = velocityTo(vec3(-0.5, 1.5, 1.7), inFront, 0.9);
  const flightAt = (rate: number, drop: (frame: number) => boolean): { at: number; position: Vec3; velocity: Vec3 } => {
    const match = createMatch(ballRules, ballRules.start(['ann', 'ben', 'cal'], 1));
    const ball = rackPosition(0, 20);
    let thrown: BallState['balls'][number] | null = null;
    let action = 0;
    for (const time of framesOf(rate, drop, 3)) {
      const fist = time < 0.8 ? ball : vec3(ball.x + 0.1, 1.4, ball.z - 0.3);
      const actions: BallInput[] = [stand(leftThrower, time, fist), hold(time, inFront)];
      if (action === 0) {
        for (const player of [0, 1, 2]) actions.push({ type: 'join', player }, { type: 'ready', player, ready: true });
        action = 1;
      } else if (action === 1 && time > 0.5) {
        actions.push({ type: 'grab', player: leftThrower, sequence: 1, side: 'right', ball: 0 });
        action = 2;
      } else if (action === 2 && time > 1) {
        // When in its frame a hand let go is the hand's own time, whenever the frame came.
        actions.push({
          type: 'throw',
          player: leftThrower,
          sequence: 2,
          side: 'right',
          ball: 0,
          at: 1,
          position: fist,
          velocity,
        });
        action = 3;
      }
      match.advance(200 + time, actions);
      const place = match.state.balls[0];
      if (place?.on === 'air') thrown ??= place;
    }
    if (thrown?.on !== 'air') throw new Error(`at ${rate} Hz nothing flew`);
    const { time: at, position, velocity: speed } = thrown.launch;
    return { at, position, velocity: speed };
  };
  const reference = flightAt(90, never);
  let worst = 0;
  for (const { rate, drop } of ways) {
    const flight = flightAt(rate, drop);
    // The positions are compared after a second of flight, at the same time of the match.
    const off = add(flight.position, addScaled(vec3(0, 0, 0), flight.velocity, reference.at + 1 - flight.at));
    const same = add(reference.position, reference.velocity);
    worst = Math.max(worst, distance(off, same));
  }
  expect(worst).toBeLessThan(1e-3);
  reportFigures('rates', { balls: `${(1000 * worst).toFixed(4)} mm apart after 1 s` });
});

test('filters of the body come to the same joints at every rate', () => {
  const skeleton = skeletonFromCalibration(defaultCalibration);
  const bodyAt = (rate: number, drop: (frame: number) => boolean) => {
    const estimator = createEstimator('ik', defaultCalibration);
    // The last frame is at the same time for all rates.
    const times = [...framesOf(rate, drop, 2), 2].map((time) => 10 + time);
    const poses = times.map((time) => poseOf(estimator, actorFrame(time, defaultCalibration)));
    return forwardKinematics(skeleton, poses.at(-1)!.body!);
  };
  const reference = bodyAt(120, never);
  let worst = 0;
  for (const { rate, drop } of ways) {
    const joints = bodyAt(rate, drop);
    worst = Math.max(worst, ...jointNames.map((joint) => distance(joints[joint].position, reference[joint].position)));
  }
  expect(worst).toBeLessThan(0.005);
  reportFigures('rates', { joints: `${(1000 * worst).toFixed(2)} mm apart` });
});
