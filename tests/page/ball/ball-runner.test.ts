import { allReleased, type Buttons, createEstimator, defaultCalibration, unknownFingers } from 'threepoint/core';
import { type BallConnection, createBallLoopbackHost } from 'threepoint-games/ball';
import type { ConnectionStatus, Visitor } from 'threepoint-rooms/room';
import { expect, test } from 'vitest';
import { ballTask } from '../../../src/page/ball/ball-task';
import { createMatchRunner } from '../../../src/page/people/match/match-runner';
import { trialOf } from '../../study/participant/played-trial';
import { poseOf } from '../../threepoint/core/estimation/drawn';
import { activityServices } from '../activity-services';
import { ballPage } from '../playing';

type Trial = ReturnType<typeof trialOf>;
const released: Buttons = { left: allReleased, right: allReleased };
const people = ['P01', 'P02', 'P03'];
const seconds = 12;
/** Frames a second of each page: half of what a headset draws, for every one of them solves a body. */
const rateHz = 36;

const spent = { tracking: 0, features: 0, inference: 0, kinematics: 1, skinning: 1, render: 3, frame: 5 };

/** The room of a server that can be cut off, and that loses its match when it is restarted. */
function restartedRoom() {
  const made = (epoch: string) => createBallLoopbackHost({ seed: 3, ball: { seconds }, epoch });
  let room = made('first');
  let cutOff: ConnectionStatus['phase'] | null = null;
  const moves: ((time: number) => void)[] = [];
  return {
    /** A connection of a page. While it is cut off the room goes on, and the page knows of it what it knew before. */
    connect(visitor: Visitor, now: number): BallConnection {
      let line = room.connect(visitor, now);
      let known = line.room;
      moves.push((time) => {
        line = room.connect(visitor, time);
      });
      return new Proxy(line, {
        get(_, name: keyof BallConnection) {
          if (!cutOff) known = line.room;
          if (name === 'room') return known;
          if (cutOff && name === 'status') return { ...line.status, phase: cutOff };
          if (cutOff && name === 'update') {
            return (time: number) => ({ ...line.update(time), events: [], poses: [], news: [] });
          }
          const value = line[name];
          return typeof value === 'function' ? value.bind(line) : value;
        },
      });
    },
    cut(phase: 'reconnecting' | 'ended'): void {
      cutOff = phase;
    },
    mend(): void {
      cutOff = null;
    },
    restart(time: number): void {
      room = made('second');
      cutOff = null;
      for (const move of moves) move(time);
    },
  };
}

/**
 * Three participants of one group in one room, each page with its own trial, frame by frame. `stopped`: the seat of the
 * second wants the clock to stand, as that page left it before it was loaded again.
 */
async function group({ stopped = false } = {}) {
  const room = restartedRoom();
  let time = 10;
  const pages = await Promise.all(
    people.map(async (participant, seat) => {
      const play = ballPage(room, { name: participant, seat, seed: 7 });
      const { settings, writer } = activityServices();
      const court = { play };
      const runner = createMatchRunner(ballTask, {
        settings,
        writer,
        opened: () => court,
        open: async () => court,
        leave: () => play.leave(),
      });
      const seatAt = async () => ({ room: 'here', token: '' });
      const place = { participant, members: people, seconds, seat: seatAt, afterAbsence: 'repeat' } as const;
      await runner.prepare(place);
      const estimator = createEstimator('ik', defaultCalibration);
      let timeFrame: (() => void) | null = null;
      let finished: ReturnType<Trial['follow']> = null;
      let trial: Trial | null = null;
      return {
        play,
        start() {
          trial = trialOf(runner, {
            ...{ task: 'ball', seconds, key: participant },
            listenToFrames: (listener) => {
              timeFrame = listener && (() => listener(spent, false));
            },
          });
          return trial;
        },
        frame() {
          play.begin(time);
          const performed = play.act(time);
          play.follow(time, performed?.frame ?? null, performed?.buttons ?? released);
          if (performed) play.sendPose(performed.frame.time, poseOf(estimator, performed.frame), unknownFingers);
          runner.played();
          timeFrame?.();
          if (!finished) finished = trial?.follow(time, performed?.frame ?? null) ?? null;
        },
        left: () => play.probe()?.secondsLeft ?? Number.NaN,
        get finished() {
          return finished;
        },
        get interrupted() {
          return trial?.runner.interrupted ?? false;
        },
      };
    }),
  );
  /** `except`: the page that draws nothing meanwhile. */
  const pass = (duration: number, except?: number) => {
    for (let i = 0; i < duration * rateHz; i++) {
      time += 1 / rateHz;
      for (const [index, page] of pages.entries()) if (index !== except) page.frame();
    }
  };
  pass(1);
  pages[1]?.play.connection?.setPaused(stopped);
  return {
    pages,
    pass,
    trials: pages.map((page) => page.start()),
    cut: room.cut,
    mend: room.mend,
    restart: () => room.restart(time),
  };
}

test('a participant who pauses a shared match stops it for the group, and no time counts', {
  tags: ['full'],
}, async () => {
  const { pages, pass, trials } = await group();
  pass(6);
  expect(trials.map(({ runner }) => runner.waitingFor)).toEqual([null, null, null]);
  trials[1]?.pause(true);
  pass(1);
  expect(trials.map(({ runner }) => runner.pausedByOther)).toEqual([true, true, true]);
  const left = pages.map((page) => page.left());
  pass(20);
  expect(pages.map((page) => page.left())).toEqual(left);
  trials[1]?.pause(false);
  pass(1);
  expect(trials.map(({ runner }) => runner.pausedByOther)).toEqual([false, false, false]);
  pass(15);
  const outcomes = pages.map(({ finished }) => finished?.outcome);
  for (const outcome of outcomes) {
    expect(outcome?.ended).toBe('time');
    expect(outcome?.seconds).toBeGreaterThan(seconds - 0.5);
    // The match is over when the last ball in the air at the bell has come down.
    expect(outcome?.seconds).toBeLessThan(seconds + 2.5);
    // The frames of the time in which the match ran; none of the time in which it stood.
    expect(outcome?.frames.count).toBeLessThan(rateHz * (seconds + 4));
    expect(outcome?.motionFrames).toBeLessThan(rateHz * (seconds + 4));
  }
  expect(new Set(outcomes.map((outcome) => outcome?.score)).size).toBe(1);
});

test('a participant who paused, reloaded and starts lets the clock of the group go on', async () => {
  const { pages, pass, trials } = await group({ stopped: true });
  pass(3);
  expect(trials.map(({ runner }) => runner.pausedByOther)).toEqual([false, false, false]);
  expect(pages.map((page) => page.left() < seconds)).toEqual([true, true, true]);
});

test('a match that surprises a slow page lasts as long for its participant as for others', {
  tags: ['full'],
}, async () => {
  const { pages, pass } = await group();
  pass(1, 0);
  pass(seconds + 8);
  const [slow, ...others] = pages.map(({ finished }) => finished?.outcome);
  expect(slow?.seconds).toBeGreaterThanOrEqual(seconds);
  for (const other of others) expect(other?.seconds).toBeCloseTo(slow?.seconds ?? Number.NaN, 1);
});

test('a match that its server has forgotten is interrupted for the group and leaves no result', async () => {
  const { pages, pass, cut, restart } = await group();
  pass(4);
  cut('reconnecting');
  pass(1);
  expect(pages.map(({ interrupted }) => interrupted)).toEqual([false, false, false]);
  restart();
  pass(seconds + 8);
  expect(pages.map(({ interrupted }) => interrupted)).toEqual([true, true, true]);
  expect(pages.map(({ finished }) => finished !== null)).toEqual([false, false, false]);
});

test.each(['before it begins', 'while it runs'])(
  'a participant who is sent away from a match %s has no result of it',
  async (when) => {
    const { pages, pass, cut } = await group();
    if (when === 'while it runs') pass(4);
    cut('ended');
    pass(seconds + 8);
    expect(pages.map(({ interrupted }) => interrupted)).toEqual([true, true, true]);
    expect(pages.map(({ finished }) => finished !== null)).toEqual([false, false, false]);
  },
);

test('a participant without a connection at the bell waits for the room’s word on the match', async () => {
  const { pages, pass, cut, mend } = await group();
  pass(4);
  cut('reconnecting');
  pass(seconds + 8);
  expect(pages.map(({ finished }) => finished !== null)).toEqual([false, false, false]);
  mend();
  pass(8);
  const outcomes = pages.map(({ finished }) => finished?.outcome);
  expect(outcomes.map((outcome) => outcome?.ended)).toEqual(['time', 'time', 'time']);
  expect(outcomes.map((outcome) => outcome?.score)).toEqual(pages.map(({ play }) => play.probe()?.score));
});
