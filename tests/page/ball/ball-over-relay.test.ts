import { createRoomPass, SocketConnection } from 'threepoint-rooms/internal';
// @module-tag full

import {
  allReleased,
  type Buttons,
  createEstimator,
  defaultCalibration,
  forwardKinematics,
  skeletonFromCalibration,
  unknownFingers,
} from 'threepoint/core';
import { distance, type Vec3 } from 'threepoint/math';
import { ballClientPolicy } from 'threepoint-games/ball';
import type { Visitor } from 'threepoint-rooms/room';
import { expect, onTestFinished, test } from 'vitest';
import type { BallPlay } from '../../../src/page/ball/match/ball-play';
import { forkServer } from '../../server/server-child';
import { poseOf } from '../../threepoint/core/estimation/drawn';
import { ballPage } from '../playing';

const released: Buttons = { left: allReleased, right: allReleased };
const serverOfRounds = (seconds: number, port = 0) =>
  forkServer({ THREEPOINT_BALL_SECONDS: String(seconds), THREEPOINT_ORIGINS: 'http://ball.test' }, { port });

interface Person {
  readonly play: BallPlay;
  /** How far each other's right elbow has gone in their own floor frame, as received here [m]. */
  readonly elbows: Map<number, number>;
  frame(): void;
}

function comeIn(port: number, name: string, options: { spectate?: boolean; bots?: boolean } = {}): Person {
  const url = `http://127.0.0.1:${port}`;
  const room = 'over-relay';
  const { spectate, bots = false } = options;
  const connect = (visitor: Visitor) =>
    new SocketConnection(ballClientPolicy, { url, room, visitor, pass: createRoomPass(url, room, 'ball') });
  const play = ballPage({ connect }, { name, spectate, bots: () => bots, readyByItself: () => !spectate, seed: 11 });
  const estimator = createEstimator('ik', defaultCalibration);
  const elbows = new Map<number, number>();
  const before = new Map<number, Vec3>();
  onTestFinished(() => play.leave());
  return {
    play,
    elbows,
    frame() {
      const time = performance.now() / 1000;
      play.begin(time);
      const performed = options.spectate ? null : play.act(time);
      const seen = play.follow(time, performed?.frame ?? null, performed?.buttons ?? released);
      if (performed) play.sendPose(performed.frame.time, poseOf(estimator, performed.frame), unknownFingers);
      for (const { id, calibration, pose } of seen?.bodies ?? []) {
        if (!pose.body) continue;
        const elbow = forwardKinematics(skeletonFromCalibration(calibration), pose.body).rightLowerArm.position;
        const last = before.get(id);
        if (last) elbows.set(id, (elbows.get(id) ?? 0) + distance(last, elbow));
        before.set(id, elbow);
      }
    },
  };
}

/** Frames of all of them, some 60 a second, until the condition holds. */
async function until(
  people: readonly Person[],
  condition: () => boolean,
  seconds: number,
  what: string,
): Promise<void> {
  const end = performance.now() + seconds * 1000;
  while (!condition()) {
    if (performance.now() > end) {
      throw new Error(`not within ${seconds} s: ${what}; ${JSON.stringify(people.map(({ play }) => play.probe()))}`);
    }
    for (const person of people) person.frame();
    await new Promise((resolve) => setTimeout(resolve, 16));
  }
}

test('three people over the relay play and agree; one person watches, one comes late', async () => {
  const server = await serverOfRounds(14);
  const players = ['ann', 'ben', 'cal'].map((name) => comeIn(server.port, name));
  const watcher = comeIn(server.port, 'dora', { spectate: true });
  const all = [...players, watcher];
  const phases = () => all.map(({ play }) => play.probe()?.phase);
  await until(all, () => phases().every((phase) => phase === 'running'), 20, 'the match runs');
  await until(all, () => (watcher.play.probe()?.score ?? 0) > 0, 20, 'a first catch');
  const late = comeIn(server.port, 'eve', { spectate: true });
  all.push(late);
  await until(all, () => (late.play.newest?.bodies.length ?? 0) === 3, 5, 'the late one sees three bodies');
  expect(late.play.probe()?.score).toBe(watcher.play.probe()?.score);
  expect(
    late.play
      .probe()
      ?.people.map((person) => person?.name)
      .sort(),
  ).toEqual(['ann', 'ben', 'cal']);
  await until(all, () => phases().every((phase) => phase === 'over'), 30, 'the match is over for all');
  const results = all.map(({ play }) => {
    const { score, end, balls } = play.probe() ?? {};
    return { score, end, basket: balls?.basket };
  });
  console.log(`score ${results[0]?.score}, by ${results[0]?.end}; elbows as ann sees them [m]:`, [
    ...(players[0]?.elbows ?? []),
  ]);
  for (const result of results) expect(result).toEqual(results[0]);
  expect(results[0]?.score).toBeGreaterThan(0);
  for (const { play, elbows } of players) {
    const me = play.probe()?.seat;
    expect([...elbows.keys()].sort()).toEqual([0, 1, 2].filter((seat) => seat !== me));
  }
  const throwers = [...watcher.elbows.entries()].filter(([seat]) => seat !== 2);
  for (const [, travelled] of throwers) expect(travelled).toBeGreaterThan(0.3);
}, 120_000);

test('a page is back in its room after the relay dies; the round is void', async () => {
  const first = await serverOfRounds(40);
  const { port } = first;
  const ann = comeIn(port, 'ann', { bots: true });
  await until([ann], () => (ann.play.probe()?.ballsLeft ?? 20) < 20, 40, 'a ball is thrown');
  await first.kill();
  await until([ann], () => ann.play.status.phase === 'reconnecting', 10, 'the page notices');
  await serverOfRounds(40, port);
  const back = performance.now();
  await until([ann], () => ann.play.status.phase === 'joined', 20, 'back in the room');
  console.log(`back in the room ${((performance.now() - back) / 1000).toFixed(1)} s after the restart`);
  await until(
    [ann],
    () => ann.play.probe()?.phase === 'running' && ann.play.probe()?.ballsLeft === 20,
    20,
    'a new round',
  );
  expect(ann.play.room?.voidedRounds).toBe(1);
}, 120_000);
