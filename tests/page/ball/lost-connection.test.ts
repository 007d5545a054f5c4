import { allReleased, type Buttons } from 'threepoint/core';
import { addScaled, type Pose, type Side, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { LossyWire } from '../../rooms/client/lossy-wire';
import { atRack, fists, holding, opening, shownAt } from '../../rooms/client/people';
import { createTestRoom } from '../../rooms/room/test-room';
import { ballPage } from '../playing';

const trigger = (pressure: number): Buttons => ({ left: allReleased, right: { ...allReleased, trigger: pressure } });

/** Ann throws by hand, Cal holds the basket; the round runs. */
function court() {
  const told = createTestRoom();
  let wire = new LossyWire(told);
  const open = (line: LossyWire) => ballPage({ connect: () => line });
  let page = open(wire);
  told.join('cal', { name: 'Cal', seat: 2 });
  for (const client of ['ann 1', 'cal']) told.room.onMessage(client, { type: 'ready', ready: true }, told.time);

  /** A frame of Ann's page with her right fist there. */
  const frame = (wrists: Readonly<Record<Side, Pose<'arena'> | null>>, pressure: number) => {
    told.pose('cal', 2, holding(opening));
    told.tick();
    look(wrists, pressure);
  };
  /** Draws a frame while the room has not come to its next tick. */
  const look = (wrists: Readonly<Record<Side, Pose<'arena'> | null>>, pressure: number) => {
    page.begin(told.time);
    const { pose } = shownAt(wire, 0, wrists);
    const tracked = { time: told.time, head: pose.head, leftHand: pose.leftHand, rightHand: pose.rightHand };
    page.follow(told.time, tracked, trigger(pressure));
    wire.sendPose(told.time, shownAt(wire, 0, wrists));
  };
  const self = {
    told,
    look,
    hold(fist: Vec3, pressure: number, seconds: number) {
      for (let i = 0; i < Math.round(seconds * 60); i++) frame(fists(vec3(-1.3, 0.8, 0), fist), pressure);
    },
    grab(ball: number) {
      self.hold(atFist(ball), 0, 0.2);
      self.hold(atFist(ball), 1, 0.2);
    },
    throw() {
      for (let i = 0; i < 15; i++) frame(fists(vec3(-1.3, 0.8, 0), addScaled(ahead, vec3(0, 3, -4), i / 60)), 1);
      self.hold(addScaled(ahead, vec3(0, 3, -4), 15 / 60), 0, 0.2);
    },
    sit: (seat: number) => page.connection?.changeSeat(seat),
    rotate: (on: boolean) => page.setOption(on),
    lose: () => wire.lose(),
    connect: () => wire.connect(),
    /** The page is loaded again; the pass that it finds makes it the same person. */
    reload() {
      wire.lose();
      self.told.pass(0.5);
      wire = new LossyWire(told, 100);
      page = open(wire);
    },
    get held() {
      return page.newest?.held.right ?? null;
    },
    ball: (number: number) => told.room.match.balls[number]?.on,
  };
  self.hold(ahead, 0, 0.5);
  expect(told.room.match.phase).toBe('running');
  return self;
}

const ahead = vec3(-0.8, 1.3, -0.3);
const atFist = (ball: number): Vec3 => addScaled(atRack(ball).right.position, vec3(0, 0, -1), 0.08);

describe('a connection that is lost for a moment', () => {
  test('leaves the ball in the hand, which throws it when it opens', () => {
    const ann = court();
    ann.grab(0);
    expect(ann.ball(0)).toBe('hand');
    ann.lose();
    ann.hold(ahead, 1, 1);
    ann.connect();
    ann.hold(ahead, 1, 0.3);
    expect([ann.held, ann.ball(0)]).toEqual([0, 'hand']);
    ann.throw();
    expect(ann.ball(0)).toBe('air');
  });

  test('loses a grab: the hand is empty, and takes the same ball anew', () => {
    const ann = court();
    ann.lose();
    ann.grab(0);
    expect(ann.held).toBe(0);
    ann.connect();
    ann.hold(ahead, 1, 0.3);
    expect([ann.held, ann.ball(0)]).toEqual([null, 'rack']);
    ann.grab(0);
    expect([ann.held, ann.ball(0)]).toEqual([0, 'hand']);
  });

  test('loses a throw: the ball goes back, and the hand takes another', () => {
    const ann = court();
    ann.grab(0);
    ann.lose();
    ann.throw();
    ann.connect();
    ann.hold(ahead, 0, 1);
    expect([ann.held, ann.ball(0)]).toEqual([null, 'rack']);
    ann.grab(2);
    expect([ann.held, ann.ball(2)]).toEqual([2, 'hand']);
  });
});

test('a request to rotate without a connection reaches the room on the next one', () => {
  const ann = court();
  ann.lose();
  ann.rotate(false);
  ann.rotate(true);
  ann.hold(ahead, 0, 0.2);
  expect(ann.told.room.match.rotate).toBe(false);
  ann.connect();
  ann.hold(ahead, 0, 0.2);
  expect(ann.told.room.match.rotate).toBe(true);
  expect(ann.told.happened('rotate')).toEqual([{ type: 'rotate', player: 0, rotate: true }]);
});

test('a connection lost for longer than a ball is kept leaves a hand empty and free', () => {
  const ann = court();
  ann.grab(0);
  ann.lose();
  ann.hold(ahead, 1, 4);
  ann.connect();
  ann.hold(ahead, 1, 0.3);
  expect([ann.held, ann.ball(0)]).toEqual([null, 'rack']);
  ann.grab(2);
  expect([ann.held, ann.ball(2)]).toEqual([2, 'hand']);
});

test('a page that is reloaded at once puts back what its player held; play goes on', () => {
  const ann = court();
  for (const ball of [0, 1]) {
    ann.grab(ball);
    ann.throw();
    expect(ann.ball(ball)).not.toBe('rack');
  }
  ann.grab(2);
  ann.reload();
  ann.hold(ahead, 1, 1);
  expect([ann.held, ann.ball(2)]).toEqual([null, 'rack']);
  ann.grab(3);
  expect([ann.held, ann.ball(3)]).toEqual([3, 'hand']);
  ann.throw();
  expect(ann.ball(3)).toBe('air');
});

test('a player who takes the seat of a bot with a ball puts nothing back', () => {
  const ann = court();
  ann.told.join('bot', { name: 'Max', seat: 1, bot: true });
  ann.told.pass(0.1, () => ann.told.pose('bot', 1, atRack(10)));
  ann.told.act('bot', { type: 'grab', sequence: 1, side: 'right', ball: 10 });
  ann.told.pass(0.1);
  expect(ann.ball(10)).toBe('hand');
  ann.sit(1);
  ann.look(fists(ahead), 0);
  ann.hold(vec3(0.8, 1.3, -0.3), 0, 1);
  expect([ann.ball(10), ann.told.happened('refused')]).toEqual(['rack', []]);
});

test('a thrower who changes seats keeps no ball', () => {
  const ann = court();
  ann.grab(0);
  ann.sit(1);
  ann.hold(ahead, 1, 0.3);
  expect([ann.held, ann.ball(0)]).toEqual([null, 'rack']);
});
