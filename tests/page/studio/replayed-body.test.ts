import { Body, type PoseRegressor } from 'threepoint';
import {
  type Calibration,
  type EstimatorName,
  estimatedJoints,
  forwardKinematics,
  type PaperMethod,
  skeletonFromCalibration,
} from 'threepoint/core';
import { ReplayedBody } from 'threepoint/internal';
import { distance } from 'threepoint/math';
import { describe, expect, test, vi } from 'vitest';
import { Recorder } from '../../../src/page/studio/recorder';
import { movingPerson } from '../../threepoint/core/estimation/moving-person';
import { openPlainModel } from '../../threepoint/core/estimation/shipped-models';

const calibration: Calibration = { eyeHeight: 1.65, armSpan: 1.56 };
const at = movingPerson(3, calibration, { x: 1, z: -0.5, yaw: 2 });
const rateHz = 60;
const frames = Array.from({ length: 4 * rateHz }, (_, i) => at(i / rateHz));
const moment = 2.5;

/** The network with answers that come later, as a worker's do. */
const answeringLater = ({ runNow: _, ...regressor }: PoseRegressor): PoseRegressor => regressor;

/** A body that replays a moving person, frame by frame of a page at 60 Hz. */
async function replaying(method: EstimatorName, later = false) {
  const recorder = new Recorder();
  recorder.load('walk.json', { device: 'a test', rateHz, calibration, frames });
  recorder.replay();
  const networks = async () => (later ? answeringLater(await openPlainModel()) : openPlainModel());
  const body = new Body<PaperMethod>({ networks, calibration, estimator: method });
  await body.setEstimator(method);
  const replayed = new ReplayedBody(body, recorder);
  const skeleton = skeletonFromCalibration(calibration);
  let page = 100;
  /** Draws `count` frames of the page; returns the joints after the last. */
  const draw = (count: number) => {
    let pose = body.pose;
    for (let i = 0; i < count; i++) {
      page += 1 / rateHz;
      pose = replayed.update(recorder.sample(page), recorder.person);
    }
    return structuredClone(forwardKinematics(skeleton, pose!.body!));
  };
  const seek = (seconds: number) => {
    recorder.seek(seconds);
    body.discontinuity();
  };
  return { recorder, body, draw, seek };
}

type Drawn = ReturnType<Awaited<ReturnType<typeof replaying>>['draw']>;
/** How far apart the joints are that no device tracks, at most [m]. */
const apart = (a: Drawn, b: Drawn): number =>
  Math.max(...estimatedJoints.map((joint) => distance(a[joint].position, b[joint].position)));

/** What a method draws of the moment when it came there playing. */
async function playedUpTo(method: EstimatorName): Promise<Drawn> {
  const { recorder, draw } = await replaying(method);
  draw(1);
  while (recorder.seconds < moment - 1e-6) draw(1);
  expect(recorder.seconds).toBeCloseTo(moment, 6);
  return draw(0);
}

describe('a replay that stands still', () => {
  test('does not let the body forget how it moved', async () => {
    const { recorder, draw } = await replaying('learned');
    const moving = draw(1 + moment * rateHz);
    recorder.setPaused(true);
    expect(apart(draw(3 * rateHz), moving)).toBe(0);
    recorder.setPaused(false);
    const { recorder: other, draw: drawOther } = await replaying('learned');
    drawOther(1 + moment * rateHz);
    expect(apart(draw(20), drawOther(20))).toBeLessThan(1e-3);
    expect(recorder.seconds).toBeCloseTo(other.seconds, 6);
  });

  test.each(['ik', 'learned'] as const)(
    'shows a method that is switched to, %s, as it draws a person who moves',
    async (method) => {
      const { recorder, body, draw, seek } = await replaying(method === 'ik' ? 'learned' : 'ik');
      draw(1);
      recorder.setPaused(true);
      seek(moment);
      draw(1);
      await body.setEstimator(method);
      expect(apart(draw(1), await playedUpTo(method))).toBeLessThan(1e-3);
    },
  );

  test('is drawn at another second as by a body that came there moving', async () => {
    const { recorder, draw, seek } = await replaying('learned');
    draw(30);
    recorder.setPaused(true);
    seek(moment);
    const scrubbed = draw(1);
    expect(apart(scrubbed, await playedUpTo('learned'))).toBeLessThan(1e-3);
    const { draw: drawStanding, recorder: other, body } = await replaying('learned');
    other.seek(moment);
    drawStanding(1);
    body.discontinuity();
    for (let i = 0; i < rateHz; i++) body.update({ ...at(moment), time: 200 + i / rateHz });
    expect(apart(drawStanding(0), scrubbed), 'a person who stands there is drawn otherwise').toBeGreaterThan(0.005);
  });

  test('waits for a network that answers later, and shows what came before until then', async () => {
    const { recorder, body, draw, seek } = await replaying('learned', true);
    draw(1);
    recorder.setPaused(true);
    seek(moment);
    draw(1);
    const moving = await playedUpTo('learned');
    await expect.poll(() => apart(draw(1), moving)).toBeLessThan(0.01);
    expect(body.estimator).toBe('learned');
  });

  test('is given up where the body jumps before a late network has answered', async () => {
    const { body } = await replaying('learned', true);
    body.update(at(1));
    const lived = body.warmUp([at(1.5), at(1.6)]);
    body.discontinuity();
    const before = body.pose;
    await lived;
    expect(body.pose).toBe(before);
  });
});

test('a replay that restarts is drawn without a way from its end', async () => {
  const { recorder, body, draw } = await replaying('ik');
  recorder.setLoop(true);
  draw(1);
  const jumped = vi.spyOn(body, 'discontinuity');
  draw(frames.length - 1);
  expect(recorder.seconds).toBeCloseTo((frames.length - 1) / rateHz, 6);
  expect(jumped).not.toHaveBeenCalled();
  const begun = draw(1);
  expect(recorder.seconds).toBe(0);
  expect(jumped).toHaveBeenCalledTimes(1);
  const { body: other, draw: drawOther } = await replaying('ik');
  drawOther(frames.length);
  other.discontinuity();
  const pose = other.update({ ...frames[0]!, time: 200 }, calibration);
  expect(apart(begun, structuredClone(forwardKinematics(skeletonFromCalibration(calibration), pose!.body!)))).toBe(0);
});
