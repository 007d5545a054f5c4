import { allReleased, type Button, ButtonPresses } from 'threepoint/core';
import { add, addScaled, distance, dot, fromAxisAngle, normalise, rotate, type Side, up, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { arrowLength, arrowRestHeight, braceHeight, maximumDraw } from '../../../src/games/archery/bow';
import { holdSeconds } from '../../../src/games/archery/held-bow';
import { archeryRules } from '../../../src/games/archery/rules';
import { fistOf } from '../../../src/games/fist';
import { reportFigures } from '../../reliability/report-figures';
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
  test('begins at 0.6 and ends below 0.4, so that trembling fingers press once', () => {
    const archer = bowman();
    archer.hold({}, 0.1, 0).hold({}, 0.05, 0.55);
    expect(archer.said).toEqual(['near-string']);
    archer.hold({}, 0.05, 0.62);
    archer.move((share) => ({ draw: 0.5 * share }), 0.5, 0.45).hold({ draw: 0.5 }, 0.5, 0.41);
    expect(archer.bow!.stage).toBe('anchored');
    archer.hold({ draw: 0.5 }, 0.05, 0.39);
    expect(archer.releases).toHaveLength(1);
  });

  test('a button that is down when a hand comes into sight was not pressed then', () => {
    const presses = new ButtonPresses();
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

  test('goes on drawing when it comes back in time', () => {
    const archer = bowman();
    archer.drawTo(0.5).hold({ draw: 0.5, lost: ['right'] }, 0.3, 0);
    archer.hold({ draw: 0.5 }, 0.4, 1);
    expect(archer.bow!.stage).toBe('anchored');
    archer.hold({ draw: 0.5 }, 0.05, 0);
    expect(archer.said.slice(2)).toEqual(['anchored', 'lost', 'resumed', 'anchored', 'released']);
    expect(archer.releases).toHaveLength(1);
  });

  test('cancels when it comes back with the string released', () => {
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
    const cancelled = archer.said.filter((type) => type === 'cancelled').length;
    expect(cancelled).toBe(10);
    expect(archer.releases).toEqual([]);
    reportFigures('changing-hands', { 'draws cancelled': `${cancelled} of 10`, shots: archer.releases.length });
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

  test('the arrow lies on its rest, the bow points along it, the upper limb stays up', () => {
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

  test('leaves the bow as it pointed, and turns it back to the hand without a jump', () => {
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

  test.each([false, true])('turns with a floor that turns at once, as by the stick (one hand: %s)', (oneHanded) => {
    const archer = bowman({ oneHanded });
    archer.drawTo(0.5);
    const turn = fromAxisAngle(up, Math.PI / 6);
    const turned = { direction: rotate(turn, vec3(0, 0, -1)), bowAt: rotate(turn, bowAt), draw: 0.5 };
    archer
      .jump()
      .hold(turned, 1 / 90, 1)
      .hold(turned, 1 / 90, 0);
    expect(distance(archer.releases[0]!.direction, turned.direction)).toBeLessThan(1e-3);
  });
});
