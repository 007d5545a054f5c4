import { describe, expect, test } from 'vitest';
import { pictureSize, SkeletonView } from '../../../src/page/bones/skeleton-view';
import { rigs } from '../../threepoint/core/humanoid/rigs';

const { joints, bones } = rigs.find(({ name }) => name === 'Mixamo')!;
const all = joints.map((_, joint) => joint);
const pairs = [[bones.leftHand!, bones.rightHand!]] as const;
const turned = (turn: (x: number, y: number, z: number) => readonly [number, number, number]) =>
  joints.map((joint) => {
    const [x, y, z] = turn(joint.position.x, joint.position.y, joint.position.z);
    return { ...joint, position: { x, y, z } };
  });

describe('a skeleton on a picture', () => {
  test.each([
    ['as it is', turned((x, y, z) => [x, y, z])],
    ['with its back to us', turned((x, y, z) => [-x, y, -z])],
    ['facing to the side', turned((x, y, z) => [z, y, -x])],
    ['in a file with Z up', turned((x, y, z) => [x, -z, y])],
    ['in millimetres', turned((x, y, z) => [1000 * x, 1000 * y, 1000 * z])],
  ])('%s, is seen from the front, upright and whole', (_, seen) => {
    const view = new SkeletonView(seen, pairs);
    const [head, hips] = [view.place(bones.head!), view.place(bones.hips!)];
    expect(head.y).toBeLessThan(hips.y - 60);
    expect(view.place(bones.leftHand!).x).toBeGreaterThan(view.place(bones.rightHand!).x + 200);
    for (const joint of all) {
      const { x, y } = view.place(joint);
      expect(Math.min(x, y)).toBeGreaterThan(0);
      expect(Math.max(x, y)).toBeLessThan(pictureSize);
    }
  });

  test('lets a tap choose every joint, fingers after it was zoomed', () => {
    for (const joint of all) {
      const view = new SkeletonView(joints, pairs);
      let chosen: number | null = null;
      let taps = 0;
      for (; chosen !== joint && taps < 8; taps += 1) chosen = view.pick(view.place(joint), all, chosen) ?? chosen;
      expect(chosen, joints[joint]!.name).toBe(joint);
      expect(taps).toBeLessThan(7);
    }
  });

  test('chooses joints in one place one after another', () => {
    const doubled = joints.map((joint, i) =>
      i === bones.spine ? { ...joint, position: joints[bones.hips!]!.position } : joint,
    );
    const view = new SkeletonView(doubled, pairs);
    let chosen: number | null = null;
    const seen = new Set<number>();
    for (let tap = 0; tap < 8; tap++) {
      chosen = view.pick(view.place(bones.hips!), all, chosen);
      if (chosen !== null) seen.add(chosen);
    }
    expect(seen).toEqual(new Set([bones.hips, bones.spine]));
  });

  test('chooses nothing far from every joint, and shows all of it again', () => {
    const view = new SkeletonView(joints, pairs);
    expect(view.pick({ x: 5, y: 5 }, all, null)).toBeNull();
    expect(view.isZoomed).toBe(false);
    const whole = view.place(bones.head!);
    expect(view.pick(view.place(bones.leftIndexIntermediate!), all, null)).toBeNull();
    expect(view.isZoomed).toBe(true);
    view.reveal(bones.head!);
    expect(view.place(bones.head!)).toEqual({ x: pictureSize / 2, y: pictureSize / 2 });
    view.showWhole();
    expect(view.place(bones.head!)).toEqual(whole);
  });
});
