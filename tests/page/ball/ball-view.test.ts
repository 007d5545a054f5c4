import { Group } from 'three';
import { identity, vec3, zero } from 'threepoint/math';
import { ballRules } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { type BallScene, BallView } from '../../../src/page/ball/ball-view';
import { drawNowhere } from '../shell/drawing-in-node';

drawNowhere();

test('a catch shows for a moment, and not again at that second of the next match', () => {
  const view = new BallView({ quality: 'low', balls: 20, onCaption: () => undefined });
  const court = view.placed({ position: zero, orientation: identity }).object;
  const state = { ...ballRules.start(['a', 'b', 'c'], 1), phase: 'running' as const, startedAt: 0 };
  const scene = (time: number, pageTime: number): BallScene => ({
    state,
    time,
    attendants: [null, null, null],
    palms: [],
    me: null,
    opening: null,
    aim: null,
    paused: false,
    secondsLeft: 50,
    pageTime,
    inRoom: true,
    readyByItself: false,
    voices: { markOf: () => 'none', levelOf: () => 0 },
    hidden: new Set(),
    head: { position: vec3(0, 1.6, 0), orientation: identity },
  });
  /** Words over the basket at this second of a match and of the page. */
  const words = (time: number, pageTime: number): number => {
    view.show(scene(time, pageTime));
    const catches = court.getObjectByName('catches') ?? new Group();
    return catches.children.filter(({ visible }) => visible).length;
  };
  words(40, 140);
  view.playEvents([{ type: 'caught', ball: 0, player: 0, at: 40, score: 1 }], { cues: [] });
  expect([words(40.5, 140.5), words(60, 160)]).toEqual([1, 0]);
  expect([words(0, 200), words(40.5, 240.5)]).toEqual([0, 0]);
});
