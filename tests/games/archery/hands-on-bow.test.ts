import fc from 'fast-check';
import { add, cross, distance, length, normalise, otherSide, rotate, type Side, up, vec3 } from 'threepoint/math';
import { wristAround } from 'threepoint-games';
import { archeryRules, braceHeight } from 'threepoint-games/archery';
import { describe, expect, test } from 'vitest';
import { oneHandedDraw, oneHandedDrawSpeed } from '../../../src/games/archery/nocked-arrow';
import { evenly, seed, vector } from '../../threepoint/core/arbitraries';
import { bowAt, bowman } from './bowman';
import { shotWithOneHand } from './one-handed-round';

const sides: readonly Side[] = ['left', 'right'];

describe('hands', () => {
  test('mirrored archers shoot mirrored arrows', () => {
    fc.assert(
      fc.property(vector(0.4), evenly(0.3, 0.65), evenly(-0.12, 0.12), (aside, draw, off) => {
        const shots = sides.map((bowSide) => {
          const mirror = bowSide === 'left' ? 1 : -1;
          const direction = normalise(vec3(mirror * aside.x, aside.y, -1));
          const pose = { direction, off: mirror * off, bowAt: vec3(mirror * bowAt.x, bowAt.y, bowAt.z) };
          const archer = bowman({ bowSide });
          archer.drawTo(draw, pose).hold({ ...pose, draw }, 0.1, 0);
          return archer.releases[0]!;
        });
        const [left, right] = shots;
        expect(left!.draw).toBeCloseTo(right!.draw, 9);
        expect(distance(left!.position, vec3(-right!.position.x, right!.position.y, right!.position.z))).toBeLessThan(
          1e-9,
        );
        expect(
          distance(left!.direction, vec3(-right!.direction.x, right!.direction.y, right!.direction.z)),
        ).toBeLessThan(1e-9);
      }),
      { seed, numRuns: 30 },
    );
  });

  test('change in the menu takes effect at once and puts the arrow back', () => {
    const archer = bowman();
    archer.drawTo(0.5).set({ bowSide: 'right' });
    archer.hold({ draw: 0.5 }, 0.05, 0);
    expect(archer.bow).toMatchObject({ bowSide: 'right', stage: 'empty' });
    expect(archer.releases).toEqual([]);
    archer.forget().drawTo(0.5).hold({ draw: 0.5 }, 0.1, 0);
    expect(archer.releases).toHaveLength(1);
  });

  test('change by taking the bow out of the other hand, without an arrow', () => {
    const archer = bowman();
    const atGrip = { draw: -braceHeight };
    archer.hold(atGrip, 0.1);
    archer.frame(atGrip, { right: { trigger: 1 } });
    expect(archer.bow).toMatchObject({ bowSide: 'left' });
    archer.frame(atGrip, {});
    archer.frame({ draw: 0.4 }, { right: { grip: 1 } });
    expect(archer.bow).toMatchObject({ bowSide: 'left' });
    archer.frame({ draw: 0.4 }, {});
    archer.frame(atGrip, { right: { grip: 1 } });
    expect(archer.bow).toMatchObject({ bowSide: 'right', stage: 'empty' });
    expect(archer.frames.at(-1)!.cues).toMatchObject([{ type: 'taken', side: 'right' }]);
    // A page that remembers what was taken asks for what is.
    archer.set({ bowSide: 'right' });
    archer.hold({}, 0.1);
    expect(archer.bow).toMatchObject({ bowSide: 'right' });
  });

  test('a grip between string and bow nocks when it is nearer to the string', () => {
    const archer = bowman();
    const between = { draw: -0.07 };
    archer.hold(between, 0.1).hold(between, 0.1, 1, 'grip');
    expect(archer.bow).toMatchObject({ bowSide: 'left', stage: 'nocked' });
  });

  test('a grip that only helps in one-handed play does not take the bow', () => {
    const archer = bowman({ oneHanded: true });
    archer.hold({ draw: -braceHeight }, 0.1);
    archer.frame({ draw: -braceHeight }, { right: { grip: 1 } });
    expect(archer.bow).toMatchObject({ bowSide: 'left' });
  });
});

describe('one hand', () => {
  test.each(sides.flatMap((side) => (['trigger', 'pinch'] as const).map((button) => [side, button] as const)))(
    '%s, %s: draws while the button is held, aims where the knuckles point, shoots on release',
    (bowSide, button) => {
      const archer = bowman({ bowSide, oneHanded: true });
      const other = otherSide(bowSide);
      const pose = { knuckles: normalise(vec3(0.1, 0.05, -1)), lost: [other] };
      archer.hold(pose, 0.2, 0, button).hold(pose, 0.6, 1, button);
      expect(archer.bow!.draw).toBeCloseTo(oneHandedDrawSpeed * 0.6, 1);
      expect(archer.bow!.stage).toBe('drawing');
      archer.hold(pose, 1, 1, button);
      expect(archer.bow).toMatchObject({ stage: 'anchored', draw: oneHandedDraw });
      archer.hold(pose, 0.05, 0, button);
      expect(archer.releases).toHaveLength(1);
      expect(distance(archer.releases[0]!.direction, pose.knuckles)).toBeLessThan(1e-3);
    },
  );

  test.each(sides)('%s: is enough for 50 of 50', (bowSide) => {
    const state = shotWithOneHand(bowSide, archeryRules.start(['archer'], 4));
    expect(state).toMatchObject({ score: 50, end: 'targets' });
  });

  test('another button puts the arrow back', () => {
    const archer = bowman({ oneHanded: true });
    archer.hold({}, 0.1).hold({}, 1, 1);
    archer.frame({}, { left: { trigger: 1, grip: 1 } });
    archer.hold({}, 0.1, 0);
    expect(archer.said).toEqual(['nocked', 'cancelled']);
    expect(archer.releases).toEqual([]);
  });

  test('a draw quicker than the rules allow puts the arrow back; the next one is shot', () => {
    const archer = bowman({ oneHanded: true });
    archer.hold({}, 0.1).hold({}, 1, 1).hold({}, 0.05);
    archer.hold({}, 0.4, 1).hold({}, 0.05);
    expect(archer.said).toEqual(['nocked', 'released', 'nocked', 'cancelled']);
    archer.hold({}, 0.4, 1).hold({}, 0.05);
    expect(archer.releases).toHaveLength(2);
    let state = archeryRules.start(['archer'], 1);
    for (const { actions } of archer.frames) state = archeryRules.step(state, actions).state;
    expect(state.arrows, 'the rules take what was heard to fly').toHaveLength(2);
  });

  test('lost while drawing holds, then cancels', () => {
    const archer = bowman({ oneHanded: true });
    archer
      .hold({}, 0.1)
      .hold({}, 1, 1)
      .hold({ lost: ['left'] }, 0.3, 0);
    expect(archer.bow!.stage).toBe('held');
    archer.hold({ lost: ['left'] }, 0.5, 0).hold({}, 0.2, 0);
    expect(archer.releases).toEqual([]);
  });

  test('switched to two hands while drawing puts the arrow back', () => {
    const archer = bowman({ oneHanded: true });
    archer.hold({}, 0.1).hold({}, 1, 1).set({ oneHanded: false });
    archer.hold({}, 0.2, 0);
    expect(archer.releases).toEqual([]);
    expect(archer.bow!.stage).toBe('empty');
  });
});

describe('a wrist round something', () => {
  test('has its fist there, its knuckles and its thumb where they were asked', () => {
    for (const side of sides) {
      const wrist = wristAround<'floor'>(side, vec3(1, 2, 3), vec3(0, 0, -1), up);
      const thumb = rotate(wrist.orientation, vec3(side === 'left' ? 1 : -1, 0, 0));
      expect(distance(thumb, up)).toBeLessThan(1e-9);
      expect(
        distance(add(wrist.position, rotate(wrist.orientation, vec3(0, -0.025, -0.08))), vec3(1, 2, 3)),
      ).toBeLessThan(1e-9);
      // Backs of hands that hold something upright look outward.
      const back = rotate(wrist.orientation, vec3(0, 1, 0));
      expect(back.x * (side === 'left' ? -1 : 1)).toBeCloseTo(1, 9);
      expect(length(cross(thumb, back))).toBeCloseTo(1, 9);
    }
  });
});
