import { allReleased } from 'threepoint/core';
import { otherSide, type Side } from 'threepoint/math';
import { archeryRules } from 'threepoint-games/archery';
import {
  BallGestures,
  type BallInput,
  type BallState,
  ballRules,
  createSimulatedHolder,
  createSimulatedThrower,
  stations,
} from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { shotWithOneHand } from '../games/archery/one-handed-round';
import { reportFigures } from './report-figures';

test('archery with one hand: a round can be won from any height', () => {
  let won = 0;
  let played = 0;
  for (const bowSide of ['left', 'right'] as const) {
    for (const eyeHeight of [1.03, 1.6]) {
      const state = shotWithOneHand(bowSide, archeryRules.start(['archer'], 4, { eyeHeight }));
      played += 1;
      if (state.score === 50) won += 1;
    }
  }
  expect(won).toBe(played);
  reportFigures('flows', { 'archery with one hand': `${won} of ${played} rounds won` });
});

/** Runs a match of three built-in players; one of them may have one hand only. */
function ballMatch(eyeHeight: number, oneHanded: { readonly player: number; readonly side: Side } | null) {
  let state: BallState = ballRules.start(['ann', 'ben', 'cal'], 3, { balls: 8, seconds: 60 });
  const bots = stations.map((arenaFromFloor, player) =>
    player === 2
      ? createSimulatedHolder({ eyeHeight, arenaFromFloor })
      : createSimulatedThrower({ eyeHeight, arenaFromFloor }, 3 + player),
  );
  const gestures = stations.map(
    (arenaFromFloor, player) => new BallGestures(() => ({ player, state, arenaFromFloor, matchAhead: 0 })),
  );
  let waiting: BallInput[] = [0, 1, 2].flatMap((player): BallInput[] => [
    { type: 'join', player },
    { type: 'ready', player, ready: true },
  ]);
  let thrown = 0;
  for (let i = 0; state.phase !== 'over' && i < 90 * 72; i++) {
    const time = i / 72;
    bots.forEach((bot, player) => {
      const { frame, buttons } = bot.follow(time, { state, player });
      const gone = oneHanded?.player === player ? otherSide(oneHanded.side) : null;
      const seen = gone ? { ...frame, [`${gone}Hand`]: null } : frame;
      waiting.push(...gestures[player]!.follow(seen, gone ? { ...buttons, [gone]: allReleased } : buttons).actions);
    });
    while ((state.tick + 1) * ballRules.tickSeconds <= time) {
      const done = ballRules.step(state, waiting);
      waiting = [];
      state = done.state;
      thrown += done.events.filter(({ type }) => type === 'thrown').length;
      for (const gesture of gestures) gesture.onEvents(done.events);
    }
  }
  return { state, thrown };
}

test('the ball game is finished with one hand too; each person throws and catches, seated too', {
  tags: ['full'],
}, () => {
  let finished = 0;
  let played = 0;
  const figures: Record<string, string> = {};
  for (const eyeHeight of [1.03, 1.2, 1.6, 1.9, 2.06]) {
    const { state } = ballMatch(eyeHeight, null);
    played += 1;
    if (state.end === 'balls' && state.score > 0) finished += 1;
  }
  figures['ball game'] = `${finished} of ${played} matches played to the last ball`;
  expect(finished).toBe(played);
  let oneHanded = 0;
  for (const player of [0, 1, 2]) {
    for (const side of ['left', 'right'] as const) {
      const { state, thrown } = ballMatch(1.6, { player, side });
      if (state.phase === 'over' && state.score > 0 && thrown > 0) oneHanded += 1;
    }
  }
  expect(oneHanded).toBe(6);
  reportFigures('flows', { ...figures, 'ball game with one hand': `${oneHanded} of 6 matches finished with a score` });
});
