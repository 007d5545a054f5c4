import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { arrowLength, arrowRestHeight, braceHeight, maximumDraw } from '../../../../src/core/games/archery/bow';
import { releaseTowards } from '../../../../src/core/games/archery/flight';
import { createArcheryGestures, defaultArcheryGestureSettings } from '../../../../src/core/games/archery/gestures';
import { holdSeconds } from '../../../../src/core/games/archery/held-bow';
import { oneHandedDraw, oneHandedDrawSpeed } from '../../../../src/core/games/archery/nocked-arrow';
import { archeryRules } from '../../../../src/core/games/archery/rules';
import { allReleased, type Button, createButtonPresses } from '../../../../src/core/games/button-presses';
import { fistOf, wristAround } from '../../../../src/core/games/fist';
import type { Transform } from '../../../../src/core/math/pose';
import { fromAxisAngle, rotate } from '../../../../src/core/math/quat';
import { otherSide, type Side } from '../../../../src/core/math/side';
import {
  add,
  addScaled,
  cross,
  distance,
  dot,
  length,
  normalise,
  reject,
  up,
  vec3,
} from '../../../../src/core/math/vec3';
import { evenly, rotation, seed, vector } from '../../arbitraries';
import { bowAt, bowman, posed } from './bowman';

const sides: readonly Side[] = ['left', 'right'];
const buttons: readonly Button[] = ['trigger', 'grip', 'pinch'];
const degrees = (radians: number): number => (radians * 180) / Math.PI;

describe('a shot', () => {
  test.each(sides.flatMap((side) => buttons.map((button) => [side, button] as const)))(
    'bow in the %s hand, %s: nocks, draws, anchors, releases',
    (bowSide, button) => {
      const archer = bowman({ bowSide });
      archer.drawTo(0.5, {}, button);
      expect(archer.bow).toMatchObject({ bowSide, stage: 'anchored' });
      expect(archer.bow!.draw).toBeCloseTo(0.5, 6);
      archer.hold({ draw: 0.5 }, 0.1, 0, button);
      expect(archer.said).toEqual(['near-string', 'nocked', 'anchored', 'released']);
      expect(archer.releases).toHaveLength(1);
      const [shot] = archer.releases;
      expect(shot!.draw).toBeCloseTo(0.5, 6);
      expect(distance(shot!.direction, vec3(0, 0, -1))).toBeLessThan(1e-3);
      // From the arrow rest above the fist, the nock half a metre beyond brace height, the tip an arrow's length ahead.
      const nock = add(bowAt, vec3(0, arrowRestHeight, braceHeight + 0.5));
      expect(distance(shot!.position, add(nock, vec3(0, 0, -arrowLength)))).toBeLessThan(2e-3);
      expect(archer.bow).toMatchObject({ stage: 'empty', arrow: null, draw: 0 });
    },
  );

  test('is one that the rules take', () => {
    const archer = bowman();
    archer.drawTo(0.5).hold({ draw: 0.5 }, 0.05);
    const actions = archer.frames.flatMap((frame) => frame.actions);
    const { state } = archeryRules.step(archeryRules.start(['archer'], 1), actions);
    expect(state.arrowsLeft).toBe(4);
  });

  test('needs a press near the string', () => {
    const archer = bowman();
    archer.hold({ draw: 0.3 }, 0.1, 0).hold({ draw: 0.3 }, 0.1, 1);
    archer
      .move((share) => ({ draw: 0.3 - 0.3 * share }), 0.3, 1)
      .hold({ draw: 0.5 }, 0.3, 1)
      .hold({ draw: 0.5 }, 0.2, 0);
    expect(archer.said).toEqual(['near-string']);
    expect(archer.releases).toEqual([]);
  });

  test('says once that the string is near, even to a hand that trembles at the edge', () => {
    const archer = bowman();
    archer.hold({ draw: 0.4 }, 0.1);
    archer.move((share) => ({ draw: 0.18 + 0.01 * Math.sin(100 * share) }), 1, 0);
    expect(archer.said).toEqual(['near-string']);
  });

  test('needs an arrow', () => {
    const archer = bowman({ armed: false });
    archer.drawTo(0.5).hold({ draw: 0.5 }, 0.2);
    expect(archer.said).toEqual([]);
    expect(archer.bow!.stage).toBe('empty');
  });

  test('with the quiver emptied meanwhile is none', () => {
    const archer = bowman();
    archer.drawTo(0.5).set({ armed: false });
    archer.hold({ draw: 0.5 }, 0.1, 1).hold({ draw: 0.5 }, 0.1, 0);
    expect(archer.releases).toEqual([]);
    expect(archer.said).toContain('cancelled');
  });

  test('draws no further than the bow', () => {
    const archer = bowman();
    archer.drawTo(0.95);
    expect(archer.bow!.draw).toBe(maximumDraw);
  });

  test('passes through the stages in order', () => {
    const archer = bowman();
    archer.drawTo(0.5);
    const stages = archer.frames.map(({ bow }) => bow!.stage).filter((stage, i, all) => stage !== all[i - 1]);
    expect(stages).toEqual(['empty', 'nocked', 'drawing', 'anchored']);
  });

  test('is felt the harder the further it is drawn', () => {
    const archer = bowman();
    archer.hold({}, 0.1).hold({}, 0.1, 1).forget();
    archer.move((share) => ({ draw: 0.6 * share }), 1, 1);
    const pulses = archer.frames.flatMap(({ haptics }) => haptics).filter(({ seconds }) => seconds < 0.02);
    expect(pulses.length).toBeGreaterThan(20);
    expect(pulses.every(({ side }) => side === 'right')).toBe(true);
    pulses.slice(1).forEach((pulse, i) => {
      expect(pulse.strength).toBeGreaterThan(pulses[i]!.strength);
    });
    expect(archer.frames.flatMap(({ cues }) => cues).filter(({ type }) => type === 'creak').length).toBeGreaterThan(5);
  });
});

describe('pressing', () => {
  test('begins at 0.6 and ends below 0.4, so that a trembling finger neither nocks twice nor shoots', () => {
    const archer = bowman();
    archer.hold({}, 0.1, 0).hold({}, 0.05, 0.55);
    expect(archer.said).toEqual(['near-string']);
    archer.hold({}, 0.05, 0.62);
    archer.move((share) => ({ draw: 0.5 * share }), 0.5, 0.45).hold({ draw: 0.5 }, 0.5, 0.41);
    expect(archer.bow!.stage).toBe('anchored');
    archer.hold({ draw: 0.5 }, 0.05, 0.39);
    expect(archer.releases).toHaveLength(1);
  });

  test('what is down already when a hand comes into sight was not pressed then', () => {
    const presses = createButtonPresses();
    const down = { ...allReleased, trigger: 1 };
    expect(presses.follow('left', down, true)).toEqual([]);
    expect(presses.follow('left', allReleased, true)).toEqual([]);
    expect(presses.follow('left', down, true)).toEqual(['trigger']);
    expect(presses.follow('left', down, false)).toEqual([]);
    expect(presses.follow('left', down, true)).toEqual([]);
    // Half pressed may be the end of a press that was not seen.
    expect(presses.follow('left', down, false)).toEqual([]);
    expect(presses.follow('left', { ...allReleased, trigger: 0.5 }, true)).toEqual([]);
    expect(presses.follow('left', down, true)).toEqual([]);
  });

  test('the string hand lets go with the button that nocked, not with the others', () => {
    const archer = bowman();
    archer.drawTo(0.5, {}, 'grip');
    archer.frame({ draw: 0.5 }, { right: { grip: 1, trigger: 1 } });
    archer.frame({ draw: 0.5 }, { right: { grip: 1 } });
    expect(archer.releases).toEqual([]);
    archer.frame({ draw: 0.5 }, { right: { trigger: 1 } });
    expect(archer.releases).toHaveLength(1);
  });

  test('a pinch that seems to open for one frame does not shoot', () => {
    const archer = bowman();
    archer.drawTo(0.5, {}, 'pinch');
    archer.frame({ draw: 0.5 }, { right: { pinch: 0.1 } });
    archer.hold({ draw: 0.5 }, 0.1, 1, 'pinch');
    expect(archer.bow!.stage).toBe('anchored');
    expect(archer.releases).toEqual([]);
  });

  test('a pinch that opens as the camera loses the hand does not shoot', () => {
    const archer = bowman();
    archer.drawTo(0.5, {}, 'pinch');
    archer.frame({ draw: 0.5 }, { right: { pinch: 0 } });
    archer.hold({ draw: 0.5, lost: ['right'] }, 0.2, 0, 'pinch');
    expect(archer.bow!.stage).toBe('held');
    archer.hold({ draw: 0.5 }, 0.1, 1, 'pinch');
    expect(archer.releases).toEqual([]);
    archer.hold({ draw: 0.5 }, 0.1, 0, 'pinch');
    expect(archer.releases).toHaveLength(1);
  });
});

describe('an arrow that is not shot', () => {
  test.each(sides)('returns to the quiver when the string goes back first, bow in the %s hand', (bowSide) => {
    const archer = bowman({ bowSide });
    archer.drawTo(0.5);
    archer.move((share) => ({ draw: 0.5 - 0.42 * share }), 0.5, 1).hold({ draw: 0.08 }, 0.1, 0);
    expect(archer.releases).toEqual([]);
    expect(archer.said).toEqual(['near-string', 'nocked', 'anchored', 'cancelled']);
    expect(archer.bow).toMatchObject({ stage: 'empty', arrow: null });
    archer.forget().drawTo(0.5).hold({ draw: 0.5 }, 0.1, 0);
    expect(archer.releases).toHaveLength(1);
  });

  test('leaves the anchor when the string goes on', () => {
    const archer = bowman();
    archer.drawTo(0.5).move((share) => ({ draw: 0.5 - 0.15 * share }), 0.2, 1);
    expect(archer.bow!.stage).toBe('drawing');
  });

  test('does not fly backward: a string hand before the bow draws nothing', () => {
    const archer = bowman();
    archer
      .hold({}, 0.1)
      .hold({}, 0.1, 1)
      .move((share) => ({ draw: -0.9 * share }), 0.5, 1);
    expect(archer.bow!.draw).toBe(0);
    archer.hold({ draw: -0.9 }, 0.1, 0);
    expect(archer.releases).toEqual([]);
  });
});

describe('a hand that is lost', () => {
  const losses = sides.flatMap((bowSide) =>
    sides.flatMap((lost) => (['lost', 'emulated'] as const).map((how) => [bowSide, lost, how] as const)),
  );

  test.each(losses)('bow %s, %s hand %s: holds, cancels, never shoots', (bowSide, side, how) => {
    const archer = bowman({ bowSide });
    archer.drawTo(0.5);
    const { direction } = archer.bow!.arrow!;
    archer.forget();
    // Its button lets go, as many devices do.
    archer.hold({ draw: 0.5, [how]: [side] }, holdSeconds - 0.05, 0);
    for (const { bow } of archer.frames) {
      expect(bow).toMatchObject({ stage: 'held', draw: 0.5 });
      expect(distance(bow!.arrow!.direction, direction)).toBeLessThan(1e-9);
    }
    archer.hold({ draw: 0.5, [how]: [side] }, 0.3, 0);
    expect(archer.said).toEqual(['lost', 'cancelled']);
    archer.hold({ draw: 0.5 }, 0.3, 0);
    expect(archer.releases).toEqual([]);
    expect(archer.bow).toMatchObject({ stage: 'empty', arrow: null });
  });

  test('and comes back in time goes on drawing', () => {
    const archer = bowman();
    archer.drawTo(0.5).hold({ draw: 0.5, lost: ['right'] }, 0.3, 0);
    archer.hold({ draw: 0.5 }, 0.4, 1);
    expect(archer.bow!.stage).toBe('anchored');
    archer.hold({ draw: 0.5 }, 0.05, 0);
    expect(archer.said.slice(2)).toEqual(['anchored', 'lost', 'resumed', 'anchored', 'released']);
    expect(archer.releases).toHaveLength(1);
  });

  test('and let go meanwhile cancels when it comes back', () => {
    const archer = bowman();
    archer
      .drawTo(0.5)
      .hold({ draw: 0.5, lost: ['right'] }, 0.2, 1)
      .hold({ draw: 0.5 }, 0.2, 0);
    expect(archer.said.at(-1)).toBe('cancelled');
    expect(archer.releases).toEqual([]);
  });

  test('leaves the bow where it was for a moment, then no hand holds it', () => {
    const archer = bowman();
    archer.hold({}, 0.2).hold({ lost: ['left'] }, 0.3);
    expect(distance(archer.bow!.bow.position, bowAt)).toBeLessThan(1e-9);
    archer.hold({ lost: ['left'] }, 0.4);
    expect(archer.bow).toBeNull();
    archer.hold({}, 0.05);
    expect(archer.bow!.stage).toBe('empty');
  });

  test('a pause of the whole page does not shoot either', () => {
    const archer = bowman();
    archer.drawTo(0.5);
    archer.frame({ draw: 0.5 }, {}, 20);
    archer.hold({ draw: 0.5 }, 0.2, 0);
    expect(archer.releases).toEqual([]);
    expect(archer.said.at(-1)).toBe('cancelled');
  });

  test('a controller that becomes a bare hand while drawing cancels, ten times', () => {
    const archer = bowman();
    for (let i = 0; i < 10; i++) {
      const [before, after] = i % 2 ? (['hand', 'controller'] as const) : (['controller', 'hand'] as const);
      const button = before === 'hand' ? 'pinch' : 'trigger';
      archer.frame({}, { right: { kind: before } });
      archer.frame({}, { right: { kind: before, [button]: 1 } });
      for (let k = 1; k <= 20; k++) archer.frame({ draw: 0.025 * k }, { right: { kind: before, [button]: 1 } });
      expect(archer.bow!.stage).not.toBe('empty');
      for (let k = 0; k < 5; k++) archer.frame({ draw: 0.5 }, { right: { kind: after } });
      expect(archer.bow!.stage).toBe('empty');
    }
    expect(archer.releases).toEqual([]);
    expect(archer.said.filter((type) => type === 'cancelled')).toHaveLength(10);
  });
});

describe('the aim', () => {
  test('is the line from the string hand to the bow, not the way the knuckles point', () => {
    const direction = normalise(vec3(0.2, 0.1, -1));
    const pose = { direction, knuckles: normalise(vec3(-0.3, 0.4, -1)) };
    const archer = bowman();
    archer.drawTo(0.5, pose);
    const { nock, direction: aim } = archer.bow!.arrow!;
    expect(degrees(Math.acos(dot(aim, direction)))).toBeLessThan(1);
    // From the string hand over the arrow rest of the bow as it is seen.
    expect(distance(nock, fistOf(posed(0, { ...pose, draw: 0.5 }).rightHand!))).toBeLessThan(1e-3);
  });

  test('goes half the way to a new direction in 50 ms, at any frame rate', () => {
    const from = vec3(0, 0, -1);
    const to = rotate(fromAxisAngle(up, 0.2), from);
    for (const rate of [60, 72, 80, 90, 120]) {
      const archer = bowman({}, rate);
      archer.drawTo(0.5, { direction: from }).hold({ draw: 0.5, direction: to }, 0.1, 1);
      // 0.1 s as this rate counts it.
      const seconds = Math.round(0.1 * rate) / rate;
      const left = Math.acos(dot(archer.bow!.arrow!.direction, to));
      expect(left).toBeCloseTo(0.2 * 2 ** (-seconds / 0.05), 4);
    }
  });

  test('steadies a trembling hand: 10 Hz to less than a third', () => {
    const archer = bowman({}, 90);
    archer.drawTo(0.5).forget();
    archer.move((share) => ({ draw: 0.5, off: 0.01 * Math.sin(2 * Math.PI * 20 * share) }), 2, 1);
    const yaws = archer.frames.slice(45).map(({ bow }) => Math.abs(bow!.arrow!.direction.x));
    const raw = 0.01 / (braceHeight + 0.5);
    expect(Math.max(...yaws)).toBeLessThan(raw / 3);
    expect(Math.max(...yaws)).toBeGreaterThan(raw / 20);
  });

  test('the arrow always lies on its rest, the bow points along it, the upper limb stays up', () => {
    const archer = bowman();
    archer.drawTo(0.5, { direction: normalise(vec3(0.3, 0.3, -1)), knuckles: vec3(0, 0, -1) });
    expect(archer.frames.filter(({ bow }) => bow?.arrow).length).toBeGreaterThan(10);
    for (const { bow } of archer.frames) {
      const { position, orientation } = bow!.bow;
      const ahead = rotate(orientation, vec3(0, 0, -1));
      const rest = add(position, rotate(orientation, vec3(0, arrowRestHeight, 0)));
      expect(rotate(orientation, up).y).toBeGreaterThan(0.9);
      expect(distance(bow!.nockPoint, addScaled(rest, ahead, -braceHeight - bow!.draw))).toBeLessThan(1e-9);
      if (bow!.arrow) expect(distance(bow!.arrow.direction, ahead)).toBeLessThan(1e-9);
    }
  });

  test('leaves the bow as it pointed: it turns back to the hand within a moment, without a jump', () => {
    const knuckles = normalise(vec3(-0.4, 0.3, -1));
    const archer = bowman();
    archer.drawTo(0.5, { knuckles }).forget();
    archer.hold({ draw: 0.5, knuckles }, 0.1, 1).hold({ draw: 0.5, knuckles }, 1, 0);
    expect(archer.said).toEqual(['released']);
    const ways = archer.frames.map(({ bow }) => rotate(bow!.bow.orientation, vec3(0, 0, -1)));
    ways.slice(1).forEach((way, i) => {
      expect(degrees(Math.acos(Math.min(1, dot(way, ways[i]!))))).toBeLessThan(4);
    });
    expect(degrees(Math.acos(dot(ways[0]!, knuckles)))).toBeGreaterThan(20);
    expect(distance(ways.at(-1)!, knuckles)).toBeLessThan(1e-9);
  });

  test('is told in the arena wherever the floor lies in it', () => {
    const arenaFromFloor: Transform<'arena', 'floor'> = {
      position: vec3(3, 0.2, -2),
      orientation: fromAxisAngle(up, 1.2),
    };
    const here = bowman();
    const there = bowman({ arenaFromFloor });
    for (const archer of [here, there]) archer.drawTo(0.5).hold({ draw: 0.5 }, 0.1, 0);
    const [a] = here.releases;
    const [b] = there.releases;
    const moved = add(arenaFromFloor.position, rotate(arenaFromFloor.orientation, a!.position));
    expect(distance(b!.position, moved)).toBeLessThan(1e-9);
    expect(distance(b!.direction, rotate(arenaFromFloor.orientation, a!.direction))).toBeLessThan(1e-9);
    expect(distance(there.bow!.bow.position, here.bow!.bow.position)).toBeLessThan(1e-9);
  });
});

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

  test('that grip between string and bow nock when they are nearer to the string', () => {
    const archer = bowman();
    const between = { draw: -0.07 };
    archer.hold(between, 0.1).hold(between, 0.1, 1, 'grip');
    expect(archer.bow).toMatchObject({ bowSide: 'left', stage: 'nocked' });
  });

  test('that only help in one-handed play do not take the bow', () => {
    const archer = bowman({ oneHanded: true });
    archer.hold({ draw: -braceHeight }, 0.1);
    archer.frame({ draw: -braceHeight }, { right: { grip: 1 } });
    expect(archer.bow).toMatchObject({ bowSide: 'left' });
  });

  test('do not draw with the press that took the bow', () => {
    const archer = bowman({ oneHanded: true, bowSide: null, rest: bowAt });
    archer.hold({}, 0.1).hold({}, 0.3, 1, 'grip');
    expect(archer.bow).toMatchObject({ bowSide: 'left', stage: 'empty' });
  });

  test('take the bow from its rest, left or right', () => {
    for (const side of sides) {
      const archer = bowman({ bowSide: null, rest: vec3(0.1, 1, -0.5) });
      // Both hands of this pose are within a step of the rest; only the one that grips takes it.
      const pose = { bowSide: side, bowAt: vec3(0.1, 1.1, -0.5), draw: 0.4 };
      archer.hold(pose, 0.1);
      expect(archer.bow).toBeNull();
      archer.frame(pose, { [otherSide(side)]: { grip: 1 } });
      expect(archer.bow).toBeNull();
      archer.frame(pose, { [side]: { grip: 1 } });
      expect(archer.bow).toMatchObject({ bowSide: side, stage: 'empty' });
    }
  });
});

describe('one hand', () => {
  test.each(sides.flatMap((side) => (['trigger', 'pinch'] as const).map((button) => [side, button] as const)))(
    '%s, %s: draws while the button is held, aims where the knuckles point, shoots when it is let go',
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
    const archer = bowman({ bowSide, oneHanded: true });
    let state = archeryRules.start(['archer'], 4);
    const at = vec3(bowSide === 'left' ? -0.1 : 0.1, 1.4, -0.5);
    for (const { centre } of state.targets) {
      // Where the knuckles must point depends a little on where the nock lies, and that on where they point.
      let knuckles = vec3(0, 0, -1);
      for (let round = 0; round < 6; round++) {
        const rest = addScaled(at, normalise(reject(up, knuckles)), arrowRestHeight);
        knuckles = releaseTowards(centre, addScaled(rest, knuckles, -braceHeight - oneHandedDraw), oneHandedDraw)!;
      }
      const pose = { bowAt: at, knuckles, lost: [otherSide(bowSide)] };
      archer.forget().hold(pose, 0.1, 0).hold(pose, 2, 1).hold(pose, 1, 0);
      for (const { actions } of archer.frames) state = archeryRules.step(state, actions).state;
    }
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

describe('any hands at all', () => {
  const anyHand = fc.option(
    fc.record({
      position: fc.record({ x: evenly(-0.6, 0.6), y: evenly(0.9, 1.7), z: evenly(-0.9, 0.3) }),
      orientation: rotation,
      tracking: fc.constantFrom('tracked' as const, 'tracked' as const, 'emulated' as const),
    }),
    { nil: null },
  );
  const pressure = fc.oneof(fc.constantFrom(0, 1), evenly(0, 1));
  const pressures = fc.record({ trigger: pressure, grip: fc.constant<number>(0), pinch: fc.constant<number>(0) });
  /** Mostly an archer who nocks, draws and lets go in some order, with everything that can go wrong in between. */
  const moment = fc.record({
    seconds: fc.oneof({ weight: 8, arbitrary: evenly(0.005, 0.03) }, { weight: 1, arbitrary: evenly(-0.1, 1) }),
    frames: fc.integer({ min: 1, max: 8 }),
    draw: fc.oneof(fc.constantFrom(0, 0.02, 0.5), evenly(-0.3, 0.9)),
    wild: fc.oneof(
      { weight: 12, arbitrary: fc.constant(null) },
      { weight: 1, arbitrary: fc.record({ leftHand: anyHand, rightHand: anyHand }) },
    ),
    left: pressures,
    right: pressures,
    settings: fc.oneof(
      { weight: 12, arbitrary: fc.constant(null) },
      {
        weight: 1,
        arbitrary: fc.record({
          bowSide: fc.constantFrom<Side | null>('left', 'right', null),
          oneHanded: fc.boolean(),
          armed: fc.constantFrom(true, true, false),
        }),
      },
    ),
  });
  type Moment = typeof moment extends fc.Arbitrary<infer T> ? T : never;
  /** A whole shot as it should be; the moments of chance come between its parts. */
  const attempt = fc
    .record({
      side: fc.constantFrom<Side>('left', 'right'),
      oneHanded: fc.constantFrom(false, false, true),
      draw: evenly(0.1, 0.8),
      chance: fc.array(fc.tuple(fc.integer({ min: 0, max: 3 }), moment), { maxLength: 3 }),
    })
    .map(({ side, oneHanded, draw, chance }): Moment[] => {
      const settings = { bowSide: side, oneHanded, armed: true };
      const held = (trigger: number) => ({ trigger, grip: 0, pinch: 0 });
      const part = (at: number, pressed: number, frames: number): Moment => ({
        ...{ seconds: 1 / 90, wild: null, settings, draw: at, frames },
        ...{ left: held(pressed), right: held(pressed) },
      });
      const parts = [part(0, 0, 2), part(0, 1, 2), part(draw, 1, 40), part(draw, 0, 3)];
      return parts.flatMap((whole, i) => [whole, ...chance.flatMap(([after, what]) => (after === i ? [what] : []))]);
    });

  test('make finite views and actions, and shots only of nocked arrows by hands that are seen', () => {
    let shots = 0;
    let cancelled = 0;
    fc.assert(
      fc.property(fc.array(attempt, { minLength: 1, maxLength: 6 }), (attempts) => {
        let settings = defaultArcheryGestureSettings;
        const gestures = createArcheryGestures(() => settings);
        let time = 100;
        let onString = false;
        for (const { seconds, frames, draw, wild, left, right, settings: change } of attempts.flat()) {
          settings = { ...settings, ...change };
          for (let i = 0; i < frames; i++) {
            time += seconds;
            const frame = { ...posed(time, { draw, bowSide: settings.bowSide ?? 'left' }), ...wild };
            const { bow, actions, cues, haptics } = gestures.follow(frame, { left, right });
            for (const action of actions) {
              if (action.type !== 'release') continue;
              shots += 1;
              expect(onString).toBe(true);
              expect(length(action.direction)).toBeCloseTo(1, 9);
              expect(Number.isFinite(length(action.position) + action.draw)).toBe(true);
              const needed = settings.oneHanded ? [bow!.bowSide] : sides;
              for (const side of needed) expect(frame[`${side}Hand`]?.tracking).toBe('tracked');
            }
            for (const { type } of cues) {
              if (type === 'nocked') onString = true;
              if (type === 'released' || type === 'cancelled') onString = false;
              if (type === 'cancelled') cancelled += 1;
            }
            if (bow) {
              const { x, y, z, w } = bow.bow.orientation;
              expect(Math.hypot(x, y, z, w)).toBeCloseTo(1, 9);
              expect(Number.isFinite(length(bow.bow.position) + length(bow.nockPoint))).toBe(true);
              expect(bow.draw).toBeGreaterThanOrEqual(0);
              expect(bow.draw).toBeLessThanOrEqual(maximumDraw);
              expect(bow.arrow === null).toBe(bow.stage === 'empty');
            }
            expect(onString).toBe(bow !== null && bow.stage !== 'empty');
            for (const { strength } of haptics) {
              expect(strength).toBeGreaterThanOrEqual(0);
              expect(strength).toBeLessThanOrEqual(1);
            }
          }
        }
      }),
      { seed, numRuns: 60 },
    );
    expect(shots).toBeGreaterThan(30);
    expect(cancelled).toBeGreaterThan(30);
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
