import { describe, expect, test } from 'vitest';
import { ArcheryGestures, defaultArcheryGestureSettings } from '../../../src/games/archery/gestures';
import { archeryRules, delayed } from '../../../src/games/archery/rules';
import { createSteeredArcher, type Steering } from '../../../src/games/archery/steered-archer';
import { createMatch } from '../../../src/games/match';

/** A person with a mouse: what is held when. */
function play(
  bowSide: 'left' | 'right',
  seconds: number,
  steer: (time: number, target: number) => Omit<Steering, 'target'>,
  rateHz = 60,
) {
  const match = createMatch(archeryRules, archeryRules.start(['mouse'], 3), { delayed });
  const archer = createSteeredArcher({ bowSide, eyeHeight: 1.6 });
  const gestures = new ArcheryGestures(() => ({ ...defaultArcheryGestureSettings, bowSide }));
  const cues: string[] = [];
  for (let i = 0; i < seconds * rateHz && match.state.phase !== 'over'; i++) {
    const time = i / rateHz;
    const at = match.state.arrows.length % 4;
    const target = match.state.targets[at];
    if (!target) throw new Error('no target');
    const { frame, buttons } = archer.follow(time, { target: target.centre, ...steer(time, at) });
    const gesture = gestures.follow(frame, buttons);
    cues.push(...gesture.cues.map(({ type }) => type));
    match.advance(time, gesture.actions);
  }
  return { state: match.state, cues };
}

describe.each(['left', 'right'] as const)('with the bow in the %s hand', (bowSide) => {
  test('an archer who points at the targets, holds and lets go scores with each', () => {
    // Two seconds held, one and a half let go: an arrow lands before the next target is aimed at.
    const { state } = play(bowSide, 30, (time) => ({ pressed: time % 3.5 < 2, cancelled: false }));
    expect(state.score).toBe(50);
    expect(state.end).toBe('targets');
  });

  test('a press too short to draw shoots nothing', () => {
    const { state, cues } = play(bowSide, 6, (time) => ({ pressed: time % 2 < 0.3, cancelled: false }));
    expect(state.arrowsLeft).toBe(5);
    expect(cues).toContain('too-soon');
  });

  test('an arrow put back is still there', () => {
    const { state, cues } = play(bowSide, 4, (time) => ({ pressed: time < 3, cancelled: time > 1.2 && time < 1.4 }));
    expect(state.arrowsLeft).toBe(5);
    expect(cues).toContain('nocked');
    expect(cues).toContain('cancelled');
    expect(cues).not.toContain('too-soon');
  });

  test.each([1.5, 2, 5])('an arrow put back is still there at %d frames a second', (rateHz) => {
    const steer = (time: number) => ({ pressed: time < 6, cancelled: time > 4 });
    const { state, cues } = play(bowSide, 9, steer, rateHz);
    expect(cues).toContain('nocked');
    expect(state.arrowsLeft).toBe(5);
  });
});
