import { describe, expect, test, vi } from 'vitest';
import { Body, type BodyOptions } from '../../../src/threepoint/api/body';
import { copyAvatarPose } from '../../../src/threepoint/core/body/avatar-pose';
import { type Calibration, defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../src/threepoint/core/body/forward-kinematics';
import { closedHand, type Fingers, flatHand, makeHandShape } from '../../../src/threepoint/core/body/hand-shape';
import { skeletonFromCalibration } from '../../../src/threepoint/core/body/skeleton';
import type { NetworkName } from '../../../src/threepoint/core/estimation/estimators';
import { estimatorNames } from '../../../src/threepoint/core/estimation/pose-estimator';
import { distance } from '../../../src/threepoint/core/math/vec3';
import { createPageClock } from '../../../src/threepoint/core/tracking/page-clock';
import type { TrackingFrame } from '../../../src/threepoint/core/tracking/tracking-frame';
import { openPlainModel, openShippedModel } from '../core/estimation/shipped-models';
import { at, calibration, observed } from './observed-body';

type Observed = Awaited<ReturnType<typeof observed>>['body'];

/** Stands upright at this height of the eyes [m]. */
const standing = (time: number, eyeHeight: number): TrackingFrame => ({
  time,
  head: { position: { x: 0, y: eyeHeight, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 }, tracking: 'tracked' },
  leftHand: null,
  rightHand: null,
});

describe('a body', () => {
  test('by an estimator that there is none of is refused in a sentence', () => {
    expect(() => new Body({ estimator: 'Learned' as 'learned' })).toThrow(
      '“Learned” is not an estimator. Use one of hands-only, ik',
    );
  });

  test('follows three points: its wrists lie on the hands, by the network that was chosen', async () => {
    const { body, reported } = await observed({ calibration });
    for (let frame = 0; frame < 30; frame++) {
      const tracked = at(frame / 60);
      const pose = body.update(tracked);
      const joints = forwardKinematics(skeletonFromCalibration(calibration), pose!.body!);
      expect(distance(joints.leftHand.position, tracked.leftHand!.position)).toBeLessThan(0.001);
      expect(distance(joints.rightHand.position, tracked.rightHand!.position)).toBeLessThan(0.001);
    }
    expect(body.estimator).toBe('learned');
    expect(reported).toEqual(['found head', 'found left', 'found right']);
  });

  test('has its frame’s fingers in the pose, where they are known; a copy keeps them', async () => {
    const { body } = await observed({ calibration, estimator: 'ik' });
    const fingers = { left: makeHandShape(), right: null };
    expect(body.update({ ...at(0), fingers })!.fingers).toEqual({ left: flatHand, right: null });
    const kept = copyAvatarPose(body.pose!);
    fingers.left.index.knuckle = 1;
    expect(body.update({ ...at(1 / 60), fingers })!.fingers!.left!.index.knuckle).toBe(1);
    expect(kept.fingers).toEqual({ left: flatHand, right: null });
    expect(body.update(at(2 / 60))!.fingers).toEqual({ left: null, right: null });
  });

  test.each(estimatorNames)('never has a finger in the pose that is not finite (%s)', async (estimator) => {
    const networks = async (name: NetworkName) => (name === 'learned' ? openPlainModel() : openShippedModel(name));
    const { body } = await observed({ calibration, estimator, networks });
    const fingers = { left: closedHand, right: makeHandShape() };
    fingers.right.thumb.end = Number.NaN;
    expect(body.update({ ...at(0), fingers })!.fingers).toEqual({ left: closedHand, right: null });
    // reason: what a page without types may leave out
    const leftAlone = { left: closedHand } as unknown as Fingers;
    expect(body.update({ ...at(1 / 60), fingers: leftAlone })!.fingers).toEqual({ left: closedHand, right: null });
  });

  test('says once which point is lost and once that it is found', async () => {
    const { body, reported } = await observed({ calibration, estimator: 'ik' });
    for (const frame of [at(0), at(1 / 60)]) body.update(frame);
    reported.length = 0;
    for (let frame = 2; frame < 5; frame++) body.update({ ...at(frame / 60), leftHand: null });
    for (let frame = 5; frame < 8; frame++) body.update(at(frame / 60));
    expect(reported).toEqual(['lost left', 'found left']);
  });

  test('reports a hand that the device only guesses as lost: its arm sinks to rest', async () => {
    const { body, reported } = await observed({ calibration, estimator: 'ik' });
    body.update(at(0));
    reported.length = 0;
    const guessed = { ...at(1 / 60).leftHand!, tracking: 'emulated' as const };
    for (let frame = 1; frame < 4; frame++) body.update({ ...at(frame / 60), leftHand: guessed });
    body.update(at(4 / 60));
    expect(reported).toEqual(['lost left', 'found left']);
  });

  test('keeps its pose while the head is not seen', async () => {
    const { body, reported } = await observed({ calibration });
    const shown = JSON.stringify(body.update(at(0)));
    expect(JSON.stringify(body.update(null))).toBe(shown);
    expect(reported.slice(-3)).toEqual(['lost head', 'lost left', 'lost right']);
  });

  test('is as tall as the headset hangs high, and grows when its wearer stands up', async () => {
    const { body, reported } = await observed({ estimator: 'ik' });
    for (let frame = 0; frame < 60; frame++) body.update(standing(frame / 60, 1.6));
    for (let frame = 60; frame < 240; frame++) body.update(standing(frame / 60, 1.7));
    expect(reported.filter((line) => line.startsWith('calibrated'))).toEqual([
      'calibrated 1.60 headset',
      'calibrated 1.70 stood-taller',
    ]);
    expect(body.calibration.eyeHeight).toBeCloseTo(1.7, 2);
  });

  test('is as tall as a wearer stands up after sitting, and no taller on a box', async () => {
    const { body, reported } = await observed({ estimator: 'ik' });
    for (let frame = 0; frame < 120; frame++) body.update(standing(frame / 60, 1.2));
    for (let frame = 120; frame < 300; frame++) body.update(standing(frame / 60, 1.78));
    for (let frame = 300; frame < 480; frame++) body.update(standing(frame / 60, 1.95));
    expect(reported.filter((line) => line.startsWith('calibrated'))).toEqual(['calibrated 1.78 stood-taller']);
  });

  test('takes no height from a headset that is not tracked yet, nor from the moments around', async () => {
    const { body, reported } = await observed({ estimator: 'ik', autoGrow: false });
    const guessed = (time: number): TrackingFrame => {
      const frame = standing(time, 1.9);
      return { ...frame, head: { ...frame.head, tracking: 'emulated' } };
    };
    for (let frame = 0; frame < 120; frame++) body.update(guessed(frame / 60));
    for (let frame = 120; frame < 150; frame++) body.update(standing(frame / 60, 1.4));
    body.update(guessed(150 / 60));
    for (let frame = 151; frame < 190; frame++) body.update(standing(frame / 60, 1.6));
    expect(reported).toEqual(['found head']);
    for (let frame = 190; frame < 200; frame++) body.update(standing(frame / 60, 1.62));
    expect(reported).toEqual(['found head', 'calibrated 1.62 headset']);
  });

  test.each([
    ['is not seen', (body: Observed) => body.update(null)],
    ['pauses', (body: Observed) => body.discontinuity()],
  ])('takes no height from the moments before a headset %s, nor at once after', async (_, interrupt) => {
    const { body, reported } = await observed({ estimator: 'ik', autoGrow: false });
    for (let frame = 0; frame < 30; frame++) body.update(standing(frame / 60, 0.9));
    interrupt(body);
    for (let frame = 600; frame < 630; frame++) body.update(standing(frame / 60, 1.4));
    for (let frame = 630; frame < 660; frame++) body.update(standing(frame / 60, 1.62));
    expect(reported.filter((line) => line.startsWith('calibrated'))).toEqual(['calibrated 1.62 headset']);
  });

  test('keeps measures that it was given, however tall its wearer stands', async () => {
    const { body, reported } = await observed({ estimator: 'ik', calibration });
    for (let frame = 0; frame < 240; frame++) body.update(standing(frame / 60, 1.72));
    expect(reported, 'and says once that they are too small').toEqual(['found head', 'outgrown by 0.07']);
    expect(body.calibration).toEqual(calibration);
  });

  test('takes measures from an object that its page keeps changing, as a panel of sliders does', () => {
    const reported: number[] = [];
    const measures = { ...calibration };
    const body = new Body({
      estimator: 'ik',
      calibration: measures,
    });
    body.addEventListener('calibrated', ({ calibration: { eyeHeight } }) => reported.push(eyeHeight));
    const pelvis = () => body.update(at(0))!.body!.hipsPosition.y;
    const before = pelvis();
    measures.eyeHeight = 1.85;
    expect(body.calibration).toEqual(calibration);
    expect(pelvis()).toBe(before);
    measures.armSpan = 1.75;
    body.calibrate(measures);
    expect(reported).toEqual([1.85]);
    expect(pelvis()).not.toBe(before);
    measures.eyeHeight = 185;
    expect(() => body.calibrate(measures)).toThrow(RangeError);
    expect(body.calibration.eyeHeight).toBe(1.85);
  });

  test('follows a stand-in whose page goes on changing their measures', () => {
    const reported: number[] = [];
    const person = { ...calibration, eyeHeight: 1.7 };
    const body = new Body({ estimator: 'ik', calibration });
    body.addEventListener('calibrated', ({ calibration: { eyeHeight } }) => reported.push(eyeHeight));
    body.update(at(0), person);
    person.eyeHeight = 1.8;
    body.update(at(1 / 60), person);
    body.update(at(2 / 60), person);
    expect(reported).toEqual([1.7, 1.8]);
    expect(body.userCalibration).toEqual(calibration);
  });

  test('with autoGrow off does not grow, and reports nothing', async () => {
    const given = await observed({ estimator: 'ik', calibration, autoGrow: false });
    const guessed = await observed({ estimator: 'ik', autoGrow: false });
    for (let frame = 0; frame < 60; frame++) guessed.body.update(standing(frame / 60, 1.6));
    for (let frame = 60; frame < 300; frame++) {
      given.body.update(standing(frame / 60, 1.72));
      guessed.body.update(standing(frame / 60, 1.7));
    }
    expect(given.reported).toEqual(['found head']);
    expect(guessed.reported).toEqual(['found head', 'calibrated 1.60 headset']);
  });

  test('forgets measures that it was given when they are to be found out again', async () => {
    const { body, reported } = await observed({ estimator: 'ik', calibration });
    body.calibrate('auto');
    expect(body.calibration).toBe(defaultCalibration);
    for (let frame = 0; frame < 60; frame++) body.update(standing(frame / 60, 1.7));
    expect(reported).toEqual(['calibrated 1.59 default', 'found head', 'calibrated 1.70 headset']);
  });

  test('takes measures again with another session, and as given', async () => {
    const { body, reported } = await observed({ estimator: 'ik' });
    for (let frame = 0; frame < 60; frame++) body.update(standing(frame / 60, 1.6));
    body.startSession();
    for (let frame = 60; frame < 120; frame++) body.update(standing(frame / 60, 1.5));
    body.calibrate(calibration);
    expect(reported.filter((line) => line.startsWith('calibrated'))).toEqual([
      'calibrated 1.60 headset',
      'calibrated 1.50 headset',
      'calibrated 1.65 given',
    ]);
  });

  test('has no pose after a session, and reports start and end once each', async () => {
    const reported: (string | null)[] = [];
    const body = new Body({ calibration, estimator: 'ik' });
    body.addEventListener('sessionstart', () => reported.push('start'));
    body.addEventListener('sessionend', () => reported.push('end', body.pose && 'pose'));
    body.startSession();
    body.update(at(0));
    body.endSession();
    body.endSession();
    expect(body.pose).toBeNull();
    expect(reported).toEqual(['start', 'end', null]);
    expect(body.update(null)).toBeNull();
  });

  test.each(['ik', 'learned', 'device'] as const)('by %s says nothing before a page has it', async (estimator) => {
    const reported: string[] = [];
    const body = new Body({
      estimator,
      networks() {
        throw new Error('no networks here');
      },
    });
    body.addEventListener('estimatorchange', () => reported.push('changed'));
    body.addEventListener('fallback', (event) => {
      event.preventDefault();
      reported.push(`${event.estimator}: ${event.reason}`);
    });
    expect(reported).toEqual([]);
    await body.setEstimator(estimator);
    expect(body.estimator).toBe(estimator === 'learned' ? 'ik' : estimator);
    expect(reported.includes('learned: no networks here')).toBe(estimator !== 'ik');
  });

  test('keeps the offsets of grips whatever is measured, until others are set', async () => {
    const { body } = await observed({ estimator: 'ik' });
    const gripOffsets = { 'valve-index': { right: { ahead: 0.01, lean: -0.1 } } };
    body.setGripOffsets(gripOffsets);
    for (let frame = 0; frame < 60; frame++) body.update(standing(frame / 60, 1.7));
    expect(body.calibration).toMatchObject({ eyeHeight: 1.7, gripOffsets });
    body.calibrate(calibration);
    expect(body.calibration).toEqual({ ...calibration, gripOffsets });
    body.calibrate('auto');
    expect(body.userCalibration.gripOffsets).toEqual(gripOffsets);
    expect(() => body.setGripOffsets({ any: { left: { roll: 2 } } })).toThrow(
      'The offset of any is not { left, right } of at most 0.1 m and 1 rad',
    );
    body.setGripOffsets({});
    expect(body.userCalibration.gripOffsets).toEqual({});
  });

  test('refuses measures of no person', async () => {
    expect(() => new Body({ calibration: { eyeHeight: 165, armSpan: 156 } })).toThrow(RangeError);
    const { body } = await observed({ estimator: 'ik' });
    expect(() => body.calibrate({ eyeHeight: Number.NaN, armSpan: 1.5 })).toThrow(RangeError);
    // reason: what a page without types may pass
    for (const measures of [null, 1.7, 'Auto'] as unknown as Calibration[])
      expect(() => new Body({ calibration: measures })).toThrow(
        'calibration is no object of measures. Pass {eyeHeight, armSpan} in metres, or “auto”.',
      );
  });

  test('refuses an option that it does not know, and names those that it does', () => {
    // reason: what a page without types may pass
    expect(() => new Body({ calibraton: calibration } as BodyOptions)).toThrow(
      '“calibraton” is not an option of Body. Use estimator, calibration, autoGrow, networks, pinning.',
    );
  });

  test('has no pose after disposal, and warns once of a page that goes on using it', async () => {
    const { body } = await observed({ estimator: 'ik' });
    body.update(at(0));
    await body.dispose();
    const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
    expect(body.pose).toBeNull();
    for (let frame = 1; frame < 4; frame++) expect(body.update(at(frame / 60))).toBeNull();
    expect(warn.mock.calls).toEqual([
      [
        expect.stringMatching(
          /^threepoint: “update” has no effect after “dispose”\. Stop calling it, or create another/,
        ),
      ],
    ]);
    warn.mockRestore();
  });
});

describe('a body that another moves', () => {
  const other: Calibration = { eyeHeight: 1.5, armSpan: 1.4 };

  test('has their measures meanwhile, learns nothing of its wearer, and is the wearer’s again', async () => {
    const { body, reported } = await observed({ estimator: 'ik' });
    for (let frame = 0; frame < 120; frame++) body.update(standing(frame / 60, 1.7), other);
    expect(body.calibration).toEqual(other);
    expect(body.userCalibration).toBe(defaultCalibration);
    for (let frame = 120; frame < 200; frame++) body.update(standing(frame / 60, 1.62));
    expect(reported).toEqual([
      'found head',
      'calibrated 1.50 stand-in',
      'calibrated 1.59 stand-in',
      'calibrated 1.62 headset',
    ]);
  });

  test('keeps measures that its wearer is given meanwhile for when they are back', async () => {
    const { body } = await observed({ estimator: 'ik', calibration });
    body.update(at(0), other);
    const measured: Calibration = { eyeHeight: 1.7, armSpan: 1.6 };
    body.calibrate(measured);
    expect(body.calibration).toEqual(other);
    body.update(at(1 / 60));
    expect(body.calibration).toEqual(measured);
  });

  test('is where they are in their first frame: nothing is drawn on the way', async () => {
    let jumps = 0;
    const body = new Body({ estimator: 'ik', calibration });
    body.addEventListener('discontinuity', () => (jumps += 1));
    for (let frame = 0; frame < 30; frame++) body.update(at(frame / 60));
    expect(jumps).toBe(0);
    const elsewhere = standing(0.5, 1.5);
    const shown = JSON.stringify(body.update(elsewhere, other));
    const fresh = new Body({ estimator: 'ik', calibration: other });
    expect(JSON.stringify(fresh.update(elsewhere))).toBe(shown);
    body.update(standing(0.52, 1.5), other);
    expect(jumps).toBe(1);
  });
});

describe('measures of a stand-in', () => {
  test('are the same in every frame, also where a page writes them out in each', () => {
    const reported: string[] = [];
    const body = new Body({ estimator: 'ik' });
    body.addEventListener('discontinuity', () => reported.push('jumped'));
    body.addEventListener('calibrated', ({ source }) => reported.push(`calibrated ${source}`));
    const handTilts = { left: { pitch: 0.1, yaw: 0.2 } };
    for (let frame = 0; frame < 90; frame++)
      body.update(at(frame / 90), { eyeHeight: 1.65, armSpan: 1.56, handTilts: structuredClone(handTilts) });
    expect(reported).toEqual(['jumped', 'calibrated stand-in']);
    body.update(at(1), { eyeHeight: 1.65, armSpan: 1.56 });
    expect(reported).toHaveLength(4);
  });

  test('are separate from the wearer’s own, which go on meanwhile', () => {
    const body = new Body({ estimator: 'ik', calibration });
    body.update(at(0), body.userCalibration);
    const person = { ...calibration };
    body.update(at(1 / 60), person);
    body.calibrate({ eyeHeight: 1.7, armSpan: 1.6 });
    body.update(at(2 / 60), person);
    expect(body.calibration).toEqual(calibration);
  });

  test.each([
    ['of centimetres', { eyeHeight: 165, armSpan: 156 }],
    ['that are no numbers', { eyeHeight: Number.NaN, armSpan: 1.5 }],
    ['with a headset tilted by degrees', { ...calibration, gazePitch: 10 }],
  ])('%s are refused as the wearer’s are, and change nothing', (_, measures) => {
    const body = new Body({ estimator: 'ik', calibration });
    body.update(at(0));
    expect(() => body.update(at(1 / 60), measures)).toThrow(RangeError);
    expect(body.calibration).toEqual(calibration);
    expect(() => body.update(at(2 / 60))).not.toThrow();
  });
});

test('time is its own: after a pause a body is reset, half a second on', () => {
  let jumps = 0;
  const body = new Body({ estimator: 'ik' });
  body.addEventListener('discontinuity', () => (jumps += 1));
  const first = body.tick(5000);
  expect(body.tick(5020) - first).toBeCloseTo(0.02);
  expect(jumps).toBe(0);
  expect(body.tick(65_020) - first).toBeCloseTo(0.52);
  expect(jumps).toBe(1);
  expect(body.tick(10) - first).toBeGreaterThan(0.52);
});

test('bodies that share a clock are at one time, and each is reset after a pause', () => {
  const clock = createPageClock(() => 0);
  const jumped: string[] = [];
  const [first, second] = ['first', 'second'].map((name) => {
    const body = new Body({ estimator: 'ik', clock });
    body.addEventListener('discontinuity', () => jumped.push(name));
    return body;
  });
  for (const timestampMs of [5000, 5020, 65_020]) {
    const time = first!.tick(timestampMs);
    expect(second!.tick(timestampMs)).toBe(time);
  }
  expect(jumped).toEqual(['first', 'second']);
});
