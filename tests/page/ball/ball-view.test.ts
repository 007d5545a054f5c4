import { Group } from 'three';
import { identity, vec3, zero } from 'threepoint/math';
import { ballRules } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { type BallScene, BallView } from '../../../src/page/ball/ball-view';
import type { SeatFrame } from '../../../src/page/people/match/match-frame';
import { drawNowhere } from '../shell/drawing-in-node';

drawNowhere();

const scene = (time: number, pageTime: number, me: number | null = null): BallScene => ({
  state: { ...ballRules.start(['a', 'b', 'c'], 1), phase: 'running', startedAt: 0 },
  time,
  players: [null, null, null],
  palms: [],
  me,
  opening: null,
  aim: null,
  paused: false,
  secondsLeft: 50,
  pageTime,
  inRoom: true,
  readyByItself: false,
  voices: { markOf: () => 'none', levelOf: () => 0 },
  hidden: new Set(),
  isThere: () => true,
  head: { position: vec3(0, 1.6, 0), orientation: identity },
});

test('captions a refusal for users who play, and not for those who watch a built-in player', () => {
  const captions: string[] = [];
  const view = new BallView({ quality: 'low', balls: 20, onCaption: (text) => captions.push(text) });
  view.placed({ position: zero, orientation: identity });
  view.show(scene(1, 1, 0));
  for (const simulated of [true, false]) {
    view.playEvents([{ type: 'refused', player: 0, sequence: 1, reason: 'reach' }], {
      cues: [{ type: 'slipped', side: 'right', ball: 3 }],
      simulated,
    });
    expect(captions).toEqual(simulated ? [] : ['The ball slipped away', 'Too far away']);
  }
});

test('basket and name appear with the holder’s body, and the basket outlasts a holder who leaves', () => {
  const view = new BallView({ quality: 'low', balls: 20, onCaption: () => undefined });
  const court = view.placed({ position: zero, orientation: identity }).object;
  const holder: SeatFrame = {
    ...{ name: 'Cal', bot: false, presence: 'here', me: false, station: 2, ready: true, opacity: 1 },
    head: vec3(0, 1.6, -5),
  };
  const shown = (seated: SeatFrame | null, isThere: boolean, phase: BallScene['state']['phase']) => {
    const { state, ...rest } = scene(1, 1, 0);
    const players = [null, null, seated];
    view.show({ ...rest, state: { ...state, phase }, players, isThere: (seat) => seat !== 2 || isThere });
    const labels = court.getObjectByName('names')?.children.filter(({ visible }) => visible) ?? [];
    return { names: labels.length, basket: court.getObjectByName('basket')?.visible };
  };
  expect(shown(null, false, 'ready')).toEqual({ names: 0, basket: false });
  expect(shown(holder, false, 'ready')).toEqual({ names: 0, basket: false });
  expect(shown(holder, false, 'running')).toEqual({ names: 0, basket: false });
  expect(shown(holder, true, 'running')).toEqual({ names: 1, basket: true });
  expect(shown({ ...holder, presence: 'gone' }, false, 'running')).toEqual({ names: 0, basket: true });
  expect(shown(null, false, 'over')).toEqual({ names: 0, basket: true });
});

test('a catch shows for a moment, and not again at that second of the next match', () => {
  const view = new BallView({ quality: 'low', balls: 20, onCaption: () => undefined });
  const court = view.placed({ position: zero, orientation: identity }).object;
  /** Words over the basket at this second of a match and of the page. */
  const words = (time: number, pageTime: number): number => {
    view.show(scene(time, pageTime));
    const catches = court.getObjectByName('catches') ?? new Group();
    return catches.children.filter(({ visible }) => visible).length;
  };
  words(40, 140);
  view.playEvents([{ type: 'caught', ball: 0, player: 0, at: 40, score: 1 }], { cues: [], simulated: false });
  expect([words(40.5, 140.5), words(60, 160)]).toEqual([1, 0]);
  expect([words(0, 200), words(40.5, 240.5)]).toEqual([0, 0]);
});
