import { defaultCalibration, nothingPressed } from 'threepoint/core';
import { LoopbackHost } from 'threepoint-rooms/room';
import { expect, test } from 'vitest';
import { shippedRoomKinds } from '../../../server/room-kinds';
import { createMatchRunner } from '../../../src/page/people/match/match-runner';
import { activities } from '../../../src/page/shell/activity-registry';
import { english } from '../../../src/study/model/phrases/english';
import { german } from '../../../src/study/model/phrases/german';
import { checkedPlan } from '../../../src/study/model/plan/plan';
import type { PlayedStep } from '../../../src/study/model/plan/schedule';
import { checkedRecord, type TrialRecord } from '../../../src/study/model/records/study-record';
import { studyTables } from '../../../src/study/model/tables/study-tables';
import { type FinishedTrial, PlayedTrial } from '../../../src/study/participant/trial/study-trial';
import { modelsWith, simulateStudy } from '../../../src/study/simulation/simulate-study';
import { paperPlan } from '../../study/model/studies';
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
    return new TouchPlay(touchGame, { connect, visitor, acting: () => true });
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

/** The paper's study with one task: this game, for groups of two. */
function touchPlan() {
  const { planned: _, tasks, ...paper } = paperPlan();
  const [task] = tasks;
  const touch = { ...task, id: 'touch', game: 'touch', groupSize: 2, questionnaire: 'nasa-tlx-raw' };
  return checkedPlan({ ...paper, participants: 8, tasks: [touch] });
}

test('two entries make a game an activity, a room and a task in two languages', async () => {
  expect(activities.map(({ name }): string => name)).toEqual(['touch', 'archery', 'ball']);
  expect([...(await shippedRoomKinds({})).keys()]).toEqual(['touch', 'ball']);
  const key = 'ready.touch' as 'ready.ball';
  expect([english[key], german[key]]).toEqual([
    'Touch the lit targets with your hands.',
    'Berühren Sie die leuchtenden Ziele.',
  ]);
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

test('a plan has the game, and its recorded trial is a row of the table', async () => {
  const plan = touchPlan();
  const { pages, pass } = pair({ goal: 8, seconds: 20 });
  const { settings, writer } = activityServices();
  const finished: (FinishedTrial | null)[] = people.map(() => null);
  const trials = await Promise.all(
    pages.map(async (play, seat) => {
      const opened = { play };
      const runner = createMatchRunner(touchTask, {
        ...{ settings, writer },
        opened: () => opened,
        open: async () => opened,
        leave: () => play.leave(),
      });
      const participant = people[seat] as string;
      const room = { seat: async () => ({ room: 'here', token: '' }) };
      await runner.prepare({ participant, members: people, seconds: 20, ...room });
      const step = {
        kind: 'trial',
        id: 'touch/1/trial-1',
        task: 'touch',
        seconds: 20,
        embodiment: { estimator: 'ik' },
      } as PlayedStep;
      const device = () => ({ name: 'a test', refreshRateHz: rateHz, input: 'simulated' as const });
      const listenToFrames = () => undefined;
      const services = {
        calibration: () => defaultCalibration,
        device,
        estimator: () => 'ik' as const,
        listenToFrames,
      };
      const trial = new PlayedTrial(step, runner, services, {
        key: participant,
        motion: false,
        seed: 1,
        now: () => 1e9,
      });
      return { runner, trial };
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

  const simulated = simulateStudy(plan, modelsWith(plan, { answers: {}, scores: {} }), 5, 1e9);
  const example = simulated[0]?.records.find(({ kind }) => kind === 'trial') as TrialRecord;
  const record = checkedRecord({ ...example, body: { ...example.body, outcome: outcomes[0] } }, plan);
  const table = studyTables([record], plan).find(({ name }) => name === 'trials');
  expect(table?.rows[0]).toMatchObject({ task: 'touch', score: 8, maximum: 8, percent: 100, ended: 'all-touched' });
});
