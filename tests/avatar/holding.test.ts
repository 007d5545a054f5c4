import { expect, test } from 'vitest';
import { Holding } from '../../src/avatar/holding';
import { averageHand, fingerPoints, makeFingerPoints } from '../../src/core/body/hand-geometry';
import { fingerNames, makeHandShape } from '../../src/core/body/hand-shape';
import { basketInHands } from '../../src/core/games/ball/basket';
import { basketRadius, rimTube } from '../../src/core/games/ball/flight';
import { wristAround } from '../../src/core/games/fist';
import { type Pose, transformPoint } from '../../src/core/math/pose';
import type { Side } from '../../src/core/math/side';
import { dot, forward, length, reject, subtract, up, vec3 } from '../../src/core/math/vec3';

const wrists: Readonly<Record<Side, Pose<'floor'>>> = {
  left: wristAround('left', vec3(-basketRadius, 1.1, -0.4), forward, up),
  right: wristAround('right', vec3(basketRadius, 1.1, -0.4), forward, up),
};

test('both hands of a holder lie round the basket’s rim: no fingertip is in the basket but the thumbs’, which go over the rim', () => {
  const opening = basketInHands(wrists.left, wrists.right)!;
  const rim = { at: opening.position, normal: opening.normal, radius: basketRadius, tube: rimTube };
  const holding = new Holding();
  holding.fitTo(1.59);
  const hand = averageHand(1.59);
  for (const side of ['left', 'right'] as const) {
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

test('a thing that does not move in its hand is held the same way, wherever the hand is', () => {
  const holding = new Holding();
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
