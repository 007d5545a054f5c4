import { defaultCalibration, nothingPressed } from 'threepoint/core';
import { gameNames } from 'threepoint-games/all';
import { LoopbackHost } from 'threepoint-rooms/room';
import { expect, test } from 'vitest';
import { remainingSteps } from '../../../src/page/check/check-steps';
import { createMatchRunner } from '../../../src/page/people/match/match-runner';
import { activities } from '../../../src/page/shell/activity-registry';
import { trialOf } from '../../study/participant/played-trial';
import { activityServices } from '../activity-services';
import { TouchPlay, touchTask } from './game/touch-activity';
import { touchGame } from './game/touch-game';
import { type TouchGame, touchClientPolicy, touchPolicy } from './game/touch-rooms';

const rateHz = 36;
const people = ['P01', 'P02'];

/** Two pages in one room, each with the simulated player of the game. */
function pair(terms: { goal?: number; seconds?: number }) {
  const host = new LoopbackHost<TouchGame>(touchPolicy(terms), touchClientPolicy);
  let time = 10;
  const pages = people.map((name, seat) => {
    const visitor = { name, calibration: defaultCalibration, seat };
    const connect = host.connect.bind(host);
    return new TouchPlay(touchGame, { connect, visitor, readyByItself: () => true });
  });
  return {
    pages,
    /** Plays frames for this long [s]; `eachFrame` is called with the page after each of its frames. */
    pass(seconds: number, eachFrame: (page: number, time: number) => void = () => undefined) {
      for (let i = 0; i < seconds * rateHz; i++) {
        time += 1 / rateHz;
        for (const [index, play] of pages.entries()) {
          play.begin(time);
          const input = play.act(time);
          play.follow(time, input?.frame ?? null, input?.buttons ?? nothingPressed);
          eachFrame(index, time);
        }
      }
    },
  };
}

test('the headset check measures frames in the world of every activity', () => {
  const titles = new Set(remainingSteps(false).map(({ title }) => title));
  expect([...titles]).toEqual(['Frames: Mirror', 'Frames: Touch', 'Frames: Archery', 'Frames: Ball game', 'Done']);
});

test('two entries make a game an activity and a game of studies', () => {
  expect(activities.map(({ name }): string => name)).toEqual(['touch', 'archery', 'ball']);
  expect(gameNames).toEqual(['touch', 'archery', 'ball']);
});

test('two players in a room touch targets to the goal, and both pages agree', () => {
  const { pages, pass } = pair({ goal: 6 });
  pass(12);
  const states = pages.map((play) => play.newest?.state);
  for (const state of states) expect(state).toMatchObject({ phase: 'over', end: 'all-touched' });
  const touched = states.map((state) => state?.players.map((player) => player.touched));
  expect(touched[0]).toEqual(touched[1]);
  expect(touched[0]?.reduce((sum, count) => sum + count)).toBe(6);
});

test('the match is a trial of each of its players', async () => {
  const { pages, pass } = pair({ goal: 8, seconds: 20 });
  const { settings, writer } = activityServices();
  const finished: ReturnType<ReturnType<typeof trialOf>['follow']>[] = people.map(() => null);
  const trials = await Promise.all(
    pages.map(async (play, seat) => {
      const opened = { play };
      const runner = createMatchRunner(touchTask, {
        ...{ settings, writer },
        opened: () => opened,
        open: async () => opened,
        leave: () => play.leave(),
      });
      const room = { seat: async () => ({ room: 'here', token: '' }), afterAbsence: 'repeat' as const };
      await runner.prepare({ participant: people[seat] as string, members: people, seconds: 20, ...room });
      return { runner, trial: trialOf(runner, { task: 'touch', seconds: 20, motion: false }) };
    }),
  );
  pass(25, (page, time) => {
    const { runner, trial } = trials[page]!;
    runner.played();
    finished[page] ??= trial.follow(time, null);
  });
  const outcomes = finished.map((one) => one?.outcome);
  for (const outcome of outcomes) expect(outcome).toMatchObject({ ended: 'all-touched', score: 8, maximum: 8 });
  expect(outcomes.reduce((sum, outcome) => sum + (outcome?.hits ?? 0), 0)).toBe(8);
});
