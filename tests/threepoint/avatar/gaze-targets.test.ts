import { fromAxisAngle, identity, multiply, type Pose, right, rotate, up, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { GazeChoice, GazeTargets } from '../../../src/threepoint/avatar/gaze-targets';
import { makeTransform } from '../../../src/threepoint/core/math/pose';

const eyes = vec3(0.4, 1.6, -0.3);
/** A head whose face is turned to the left and up [degrees]. */
const facing = (left: number, raised = 0): Pose<'floor'> => ({
  position: eyes,
  orientation: multiply(fromAxisAngle(up, radians(left)), fromAxisAngle(right, radians(raised))),
});
const radians = (degrees: number): number => (degrees * Math.PI) / 180;
/** A place this many degrees to the left of −Z, seen from the eyes, and this far away [m]. */
const at = (left: number, metres = 2): Vec3 => {
  const { x, y, z } = rotate(fromAxisAngle(up, radians(left)), vec3(0, 0, -metres));
  return vec3(eyes.x + x, eyes.y + y, eyes.z + z);
};

function among(places: Readonly<Record<string, Vec3>>): GazeTargets {
  const targets = new GazeTargets();
  for (const [key, place] of Object.entries(places)) targets.add(key, place);
  return targets;
}

describe('eyes', () => {
  test('choose the target that the face points to most, and none that is far aside', () => {
    const gaze = new GazeChoice();
    const targets = among({ person: at(25), ball: at(-10) });
    expect(gaze.choose(targets, facing(0))).toEqual(at(-10));
    expect(gaze.choose(targets, facing(22))).toEqual(at(25));
    expect(gaze.choose(targets, facing(90))).toBeNull();
  });

  test('choose no place in the own head, and none across a field', () => {
    const gaze = new GazeChoice();
    expect(gaze.choose(among({ self: eyes, nose: at(0, 0.1) }), facing(0))).toBeNull();
    expect(gaze.choose(among({ far: at(0, 9) }), facing(0))).toBeNull();
    expect(gaze.choose(among({ lost: vec3(Number.NaN, 1, 1) }), facing(0))).toBeNull();
  });

  test('stay on a target until another is clearly closer, however the head trembles', () => {
    const gaze = new GazeChoice();
    const targets = among({ left: at(10), right: at(-10) });
    expect(gaze.choose(targets, facing(3))).toEqual(at(10));
    for (const noise of [-1, 1, -2.5, 2.5]) expect(gaze.choose(targets, facing(noise)), `${noise}`).toEqual(at(10));
    expect(gaze.choose(targets, facing(-4))).toEqual(at(-10));
    expect(gaze.choose(targets, facing(2.5))).toEqual(at(-10));
  });

  test('stay on a target at the edge of the cone while the head trembles', () => {
    const gaze = new GazeChoice();
    const targets = among({ viewer: at(31) });
    expect(gaze.choose(targets, facing(0))).toEqual(at(31));
    for (const noise of [-1, 1, -2, 2]) expect(gaze.choose(targets, facing(noise)), `${noise}`).toEqual(at(31));
    expect(gaze.choose(targets, facing(-8))).toBeNull();
    expect(gaze.choose(targets, facing(-2))).toBeNull();
  });

  test('find a target from a floor that is turned and moved', () => {
    const gaze = new GazeChoice();
    const placement = makeTransform<'floor', 'floor'>();
    Object.assign(placement, { position: vec3(3, 0, -5), orientation: fromAxisAngle(up, 2) });
    const inRoom = rotate(placement.orientation, at(5));
    const targets = among({ person: vec3(inRoom.x + 3, inRoom.y, inRoom.z - 5) });
    const chosen = gaze.choose(targets, facing(0), placement);
    expect(chosen?.x).toBeCloseTo(at(5).x, 9);
    expect(chosen?.z).toBeCloseTo(at(5).z, 9);
  });

  test('follow a ball by what it is, not by its place in the list', () => {
    const gaze = new GazeChoice();
    const targets = among({ first: at(4), second: at(-4) });
    expect(gaze.choose(targets, facing(1))).toEqual(at(4));
    targets.clear();
    targets.add('second', at(-4));
    targets.add('first', at(6));
    expect(gaze.choose(targets, { position: eyes, orientation: identity })).toEqual(at(6));
  });
});
