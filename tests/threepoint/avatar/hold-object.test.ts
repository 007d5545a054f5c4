import { wristAround } from 'threepoint-games';
import { basketInHands, basketRadius, rimTube } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { ObjectHolds } from '../../../src/threepoint/avatar/hands/hold-object';
import {
  averageHand,
  fingerPoints,
  makeFingerPoints,
  scaledHand,
} from '../../../src/threepoint/core/body/hand-geometry';
import { fingerNames, makeHandShape } from '../../../src/threepoint/core/body/hand-shape';
import { type Pose, transformPoint } from '../../../src/threepoint/core/math/pose';
import { identity } from '../../../src/threepoint/core/math/quat';
import type { Side } from '../../../src/threepoint/core/math/side';
import { distance, dot, forward, length, reject, subtract, up, vec3 } from '../../../src/threepoint/core/math/vec3';

const wrists: Readonly<Record<Side, Pose<'floor'>>> = {
  left: wristAround('left', vec3(-(basketRadius + 0.01), 1.1, -0.4), forward, up),
  right: wristAround('right', vec3(basketRadius + 0.01, 1.1, -0.4), forward, up),
};

test('both hands of a holder surround the basket’s rim, with no fingertip but the thumbs’ inside', () => {
  const opening = basketInHands(wrists.left, wrists.right)!;
  const rim = { at: opening.position, normal: opening.normal, radius: basketRadius, tube: rimTube };
  const holding = new ObjectHolds();
  const hand = averageHand(1.59);
  for (const side of ['left', 'right'] as const) {
    holding.fitTo(side, null, 1.59);
    const shape = makeHandShape();
    holding.rim(side, wrists[side], rim, shape);
    for (const name of fingerNames) {
      const [, , , tip] = fingerPoints(name, hand[name], shape[name], makeFingerPoints());
      const mirrored = side === 'right' ? vec3(-tip.x, tip.y, tip.z) : tip;
      const from = subtract(transformPoint<'floor', 'floor'>(wrists[side], mirrored), opening.position);
      const fromAxis = length(reject(from, opening.normal));
      const above = dot(from, opening.normal);
      const gap = Math.hypot(name === 'thumb' ? above : 0, fromAxis - basketRadius) - rimTube - hand[name].tipRadius;
      expect(gap, `${side} ${name}`).toBeGreaterThan(-0.003);
      if (name !== 'thumb') expect(fromAxis, `${side} ${name}`).toBeGreaterThan(basketRadius);
    }
  }
});

test('a thing that stays still in its hand is held alike wherever the hand is', () => {
  const holding = new ObjectHolds();
  const [first, second] = [makeHandShape(), makeHandShape()];
  for (const [shape, x] of [
    [first, 0],
    [second, 2],
  ] as const) {
    const wrist = { ...wrists.right, position: vec3(x, 1, 0) };
    holding.ball(
      'right',
      wrist,
      { at: transformPoint<'floor', 'floor'>(wrist, vec3(0, -0.09, -0.08)), radius: 0.075 },
      shape,
    );
  }
  expect(first).not.toEqual(makeHandShape());
  expect(second).toEqual(first);
});

test('an avatar’s own fingers, long or short, close round a ball and lie on it', () => {
  const at = vec3(0, -0.09, -0.08);
  const radius = 0.075;
  for (const size of [0.75, 1, 1.3]) {
    const own = scaledHand(averageHand(1.59), size);
    const holding = new ObjectHolds();
    holding.fitTo('left', own, 1.59);
    const wrist = { position: vec3(0, 0, 0), orientation: identity };
    const shape = makeHandShape();
    holding.ball('left', wrist, { at, radius }, shape);
    for (const name of ['index', 'middle', 'ring'] as const) {
      const [, , , tip] = fingerPoints(name, own[name], shape[name], makeFingerPoints());
      const gap = distance(tip, at) - radius - own[name].tipRadius;
      expect(gap, `${name} of a hand ${size} times as large`).toBeGreaterThan(-0.003);
      expect(gap, `${name} of a hand ${size} times as large`).toBeLessThan(0.012);
    }
  }
});
