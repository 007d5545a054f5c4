import { describe, expect, test } from 'vitest';
import { Gait } from '../../../../src/threepoint/core/estimation/gait/gait';
import { GaitFeatures, type GaitPoints } from '../../../../src/threepoint/core/estimation/gait/gait-features';
import { shippedGait } from '../../../../src/threepoint/core/estimation/gait/shipped-gait';
import { eyeHeight, standing, walking } from '../../avatar/walking-person';
import { mirrorPoint, mirrorRotation } from './moving-person';

type Person = (time: number) => GaitPoints;

const mirrorOf =
  (person: Person): Person =>
  (time) => {
    const { hips, head, leftHand, rightHand } = person(time);
    return {
      hips: { position: mirrorPoint(hips.position), orientation: mirrorRotation(hips.orientation) },
      head: { position: mirrorPoint(head.position), orientation: mirrorRotation(head.orientation) },
      leftHand: mirrorPoint(rightHand),
      rightHand: mirrorPoint(leftHand),
    };
  };

function feetAfter(person: Person, seconds: number, rateHz = 60) {
  const gait = new Gait(shippedGait);
  for (let frame = 0; frame <= seconds * rateHz; frame++)
    gait.update(person(frame / rateHz), eyeHeight, frame / rateHz);
  return gait.feet;
}

describe('expected feet', () => {
  test('stand beside the hips on their own sides when a person stands', () => {
    const { left, right } = feetAfter(standing, 3);
    expect(left.x).toBeLessThan(-0.04);
    expect(right.x).toBeGreaterThan(0.04);
    for (const foot of [left, right]) {
      expect(Math.hypot(foot.x, foot.z)).toBeLessThan(0.35);
      expect(foot.standing).toBeGreaterThan(0.6);
      expect(Math.abs(foot.yaw)).toBeLessThan(0.6);
    }
  });

  test('stand in turn when a person walks', () => {
    const gait = new Gait(shippedGait);
    let onlyLeft = 0;
    let onlyRight = 0;
    for (let frame = 0; frame < 360; frame++) {
      gait.update(walking(frame / 60), eyeHeight, frame / 60);
      if (frame < 90) continue;
      const difference = gait.feet.left.standing - gait.feet.right.standing;
      if (difference > 0.2) onlyLeft += 1;
      if (difference < -0.2) onlyRight += 1;
    }
    expect(onlyLeft).toBeGreaterThan(80);
    expect(onlyRight).toBeGreaterThan(80);
  });

  test.each([1.4, 2.1, 3.3])('are mirrored for a mirrored person, after %s s', (seconds) => {
    const plain = feetAfter(walking, seconds);
    const mirror = feetAfter(mirrorOf(walking), seconds);
    for (const [side, other] of [
      ['left', 'right'],
      ['right', 'left'],
    ] as const) {
      expect(mirror[other].x).toBeCloseTo(-plain[side].x, 5);
      expect(mirror[other].z).toBeCloseTo(plain[side].z, 5);
      expect(mirror[other].yaw).toBeCloseTo(-plain[side].yaw, 5);
      expect(mirror[other].standing).toBeCloseTo(plain[side].standing, 5);
    }
  });

  test.each([72, 90, 120])('are the same at %i Hz as at 60', (rate) => {
    const [slow, fast] = [feetAfter(walking, 2.5, 60), feetAfter(walking, 2.5, rate)].map((feet) =>
      structuredClone(feet),
    );
    for (const side of ['left', 'right'] as const) {
      expect(Math.hypot(slow![side].x - fast![side].x, slow![side].z - fast![side].z)).toBeLessThan(0.01);
      expect(Math.abs(slow![side].standing - fast![side].standing)).toBeLessThan(0.03);
    }
  });

  test('forget what was before a reset', () => {
    const gait = new Gait(shippedGait);
    for (let frame = 0; frame < 120; frame++) gait.update(walking(frame / 60), eyeHeight, frame / 60);
    gait.reset();
    gait.update(standing(0), eyeHeight, 2);
    const fresh = new Gait(shippedGait);
    fresh.update(standing(0), eyeHeight, 0);
    expect(gait.feet).toEqual(fresh.feet);
  });

  test('need weights of a gait network', () => {
    expect(() => new Gait({ trainedOn: [], tensors: {} })).toThrow('gait.inputMean');
  });
});

test('inputs of the mirrored person are those that the page computes of the mirror image', () => {
  const [plain, mirror] = [new GaitFeatures(), new GaitFeatures()];
  for (let frame = 0; frame < 100; frame++) {
    plain.update(walking(frame / 60), eyeHeight, frame / 60);
    mirror.update(mirrorOf(walking)(frame / 60), eyeHeight, frame / 60);
  }
  plain.mirrored.forEach((value, i) => {
    expect(value).toBeCloseTo(mirror.values[i]!, 6);
  });
});

test('the network was trained on nobody in the lockbox, nor on motion that may only measure', () => {
  const notTrainable = /^(001|009|049|135)$|^9\d\d$|^(bd|bk|dg|mm|tr)$/;
  expect(shippedGait.trainedOn).toHaveLength(31);
  expect(shippedGait.trainedOn.filter((person) => notTrainable.test(person))).toEqual([]);
});
