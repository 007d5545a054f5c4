import type { Vector3 } from 'three';
import type { FingerName, MutableHandShape } from 'threepoint/core';
import { dot, forward, normalise, type Pose, rotate, type Side, subtract, up, type Vec3, vec3 } from 'threepoint/math';
import { ballInPalm, wristAround } from 'threepoint-games';
import { bowInHand } from 'threepoint-games/archery';
import {
  ballRadius,
  ballRules,
  basketInHands,
  basketRadius,
  createSimulatedHolder,
  rimTube,
  stations,
} from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { bodyLabels } from '../../../src/threepoint/avatar/built-in-body-labels';
import type { ObjectHolds } from '../../../src/threepoint/avatar/hands/hold-object';
import { fingerBoneNames } from '../../../src/threepoint/core/body/finger-bone-names';
import { distanceToBall, distanceToRod } from '../../../src/threepoint/core/body/grasp';
import { fingerNames } from '../../../src/threepoint/core/body/hand-shape';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { createWithNetwork } from '../../../src/threepoint/core/estimation/with-network';
import { hangingThrower } from '../../games/ball/hanging-thrower';
import { show } from '../core/estimation/drawn';
import { openPlainModel } from '../core/estimation/shipped-models';
import { builtInBody, type DrawnSkin, drawnHands, drawnSkin, wearer } from './drawn-skin';

const sides = ['left', 'right'] as const;

/** A thing in one hand: how hands close round it, and how far a place is from what a finger may not go through [m]. */
interface Thing {
  readonly wrists: Readonly<Record<Side, Pose<'floor'>>>;
  grasp(holding: ObjectHolds, side: Side, wrist: Pose<'floor'>, target: MutableHandShape): void;
  distance(side: Side, at: Vec3, finger: FingerName | 'palm'): number;
}

const ahead = {
  left: wristAround<'floor'>('left', vec3(-0.2, 1.1, -0.4), forward, up),
  right: wristAround<'floor'>('right', vec3(0.2, 1.1, -0.4), forward, up),
};

const handle = 0.019;
const grips = { left: bowInHand('left', ahead.left), right: bowInHand('right', ahead.right) };
const bow: Thing = {
  wrists: ahead,
  grasp(holding, side, wrist, target) {
    const { position, orientation } = grips[side];
    holding.rod(side, wrist, { at: position, axis: rotate(orientation, up), radius: handle }, target);
  },
  distance: (side, at) => distanceToRod(at, grips[side].position, rotate(grips[side].orientation, up), handle),
};

const ball: Thing = {
  wrists: ahead,
  grasp: (holding, side, wrist, target) =>
    holding.ball(side, wrist, { at: ballInPalm(wrist, ballRadius), radius: ballRadius }, target),
  distance: (side, at) => distanceToBall(at, ballInPalm(ahead[side], ballRadius), ballRadius),
};

function basketIn(wrists: Thing['wrists']): Thing {
  const { position, normal } = basketInHands(wrists.left, wrists.right)!;
  return {
    wrists,
    grasp: (holding, side, wrist, target) =>
      holding.rim(side, wrist, { at: position, normal, radius: basketRadius, tube: rimTube }, target),
    // Fingers lie outside the wall below the rim, palm and thumb on the rim itself.
    distance(_, at, finger) {
      const fromWall = distanceToRod(at, position, normal, basketRadius);
      const fromRim = Math.hypot(fromWall, dot(subtract(at, position), normal));
      return (finger === 'thumb' || finger === 'palm' ? fromRim : fromWall) - rimTube;
    },
  };
}

/** A player who holds the basket before the belly, as others see one. */
function holder(): Thing['wrists'] {
  const station = stations[2]!;
  const bot = createSimulatedHolder({ eyeHeight: wearer.eyeHeight, arenaFromFloor: station });
  const { leftHand, rightHand } = bot.follow(0, { state: ballRules.start(['ann', 'ben', 'cal'], 1), player: 2 }).frame;
  return { left: leftHand!, right: rightHand! };
}

/** Hands of a person that are nearer to each other than the basket is wide, knuckles inward [m, rad]. */
function tooNear(by: number, inward: number): Thing['wrists'] {
  const wrist = (side: Side, sign: -1 | 1) => {
    const knuckles = normalise(vec3(-sign * Math.tan(inward), 0, -1));
    return wristAround<'floor'>(side, vec3(sign * (basketRadius + 0.01 - by), 1.1, -0.4), knuckles, up);
  };
  return { left: wrist('left', -1), right: wrist('right', 1) };
}

/** How near the skin of some bones of one hand comes to a thing, below 0 inside [mm]. */
function nearest(skin: DrawnSkin, bones: readonly string[], distance: (at: Vec3) => number): number {
  const places = bones.flatMap((bone): readonly Vector3[] => skin.get(bone) ?? []);
  return 1000 * Math.min(...places.map(distance));
}

/** Flesh gives way by so much where it is pressed [mm]. */
const flesh = 6.5;

describe.each(bodyLabels.map(({ name }) => name))('the hands of our %s', async (body) => {
  const avatar = await builtInBody(body);

  describe.each([
    ['a bow’s grip', bow],
    ['a ball', ball],
    ['the basket’s rim', basketIn(holder())],
    ['the rim of a basket that is wider than they are apart', basketIn(tooNear(0.01, 0.15))],
  ])('round %s', (_, { wrists, grasp, distance }) => {
    const skin = drawnHands(avatar, wrists, grasp);

    test.each(sides)('have no finger of the %s one in it, and fingertips on it', (side) => {
      for (const finger of fingerNames) {
        const [, middle, end] = fingerBoneNames(side, finger) as [string, string, string];
        const gap = nearest(skin, [middle, end], (at) => distance(side, at, finger));
        expect(gap, finger).toBeGreaterThan(-flesh);
        if (finger !== 'thumb') expect(gap, finger).toBeLessThan(10);
      }
    });
  });

  test('lie on the basket’s rim with their palms, not in it', () => {
    const { wrists, grasp, distance } = basketIn(holder());
    const skin = drawnHands(avatar, wrists, grasp);
    for (const side of sides) {
      const gap = nearest(skin, [`${side}Hand`], (at) => distance(side, at, 'palm'));
      expect(gap, side).toBeGreaterThan(-2);
      expect(gap, side).toBeLessThan(8);
    }
  });

  test.each(['ik', 'learned'] as const)(
    'hold a ball beside the thigh when they hang, not in it: %s',
    async (method) => {
      const { frame } = hangingThrower(wearer.eyeHeight);
      const estimator = method === 'ik' ? createIk(wearer) : createWithNetwork(method, wearer, openPlainModel());
      for (let step = 0; step <= 30; step++) {
        const time = step / 30;
        avatar.setPose(await show(estimator, { ...frame, time }), time);
      }
      const skin = drawnSkin(avatar, /hips|UpperLeg|LowerLeg/);
      for (const hand of [frame.leftHand, frame.rightHand]) {
        const at = ballInPalm(hand!, ballRadius);
        const gap = nearest(skin, [...skin.keys()], (place) => distanceToBall(place, at, ballRadius));
        expect(gap).toBeGreaterThan(0);
      }
    },
  );
});
