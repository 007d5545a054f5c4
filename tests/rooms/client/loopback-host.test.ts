import { type BallInput, ballRules, createBallLoopbackHost } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { atRack, createPerson, fists, holding, opening, releaseOf, visitor } from './people';

/** Three people in a room of this page, frame by frame at 72 Hz. */
function threeTogether(options: Parameters<typeof createBallLoopbackHost>[0] = {}) {
  const host = createBallLoopbackHost(options);
  let time = 100;
  const people = ['Ann', 'Ben', 'Cal'].map((name) => createPerson(host.connect(visitor(name), time)));
  const [ann, ben, cal] = people as [(typeof people)[0], (typeof people)[0], (typeof people)[0]];
  ann.place(fists(releaseOf(0)));
  ben.place(fists(releaseOf(1)));
  cal.place(holding(opening));
  const frame = () => {
    time += 1 / 72;
    for (const person of people) person.frame(time);
  };
  const pass = (seconds: number) => {
    for (let i = 0; i < seconds * 72; i++) frame();
  };
  const begin = () => {
    for (const person of people) person.connection.setReady(true);
    pass(0.1);
  };
  return {
    host,
    people,
    ann,
    ben,
    cal,
    frame,
    pass,
    begin,
    get time() {
      return time;
    },
    throwBall(ball: number, person = ann) {
      person.place(atRack(ball, person.match.options.balls));
      pass(0.2);
      person.grab(ball);
      pass(0.1);
      person.place(fists(releaseOf(person.seat)));
      pass(0.1);
      person.toss(ball, time);
      pass(0.1);
    },
  };
}

describe('a room in the page', () => {
  test('gives the three their seats in the order in which they come, a fourth watches', () => {
    const { host, people, time } = threeTogether();
    expect(people.map(({ seat }) => seat)).toEqual([0, 1, 2]);
    const fourth = host.connect(visitor('Dot'), time);
    expect(fourth.room?.mySeat).toBeNull();
    expect(fourth.room?.seats.map((row) => row?.name)).toEqual(['Ann', 'Ben', 'Cal']);
    expect(fourth.room?.spectators).toBe(1);
  });

  test('plays a ball from rack to basket, and all three see the same', () => {
    const three = threeTogether();
    three.begin();
    expect(three.ann.match.phase).toBe('running');
    three.throwBall(3);
    expect(three.ann.match.balls[3]?.on).toBe('air');
    three.pass(1.2);
    for (const { match } of three.people) {
      expect(match.balls[3]).toEqual({ on: 'basket', thrower: 0 });
      expect(match.score).toBe(1);
    }
    expect(three.ben.happened('caught')).toHaveLength(1);
  });

  test('shows a grab and a throw to the acting hand before the Room knows of them', () => {
    const { ann, begin, pass, frame, time } = threeTogether();
    begin();
    ann.place(atRack(0));
    pass(0.2);
    ann.grab(0);
    expect(ann.match.balls[0]).toEqual({ on: 'hand', player: 0, side: 'right' });
    frame();
    expect(ann.happened('grabbed')).toHaveLength(0);
    frame();
    expect(ann.happened('grabbed')).toHaveLength(1);
    ann.toss(0, time);
    expect(ann.match.balls[0]).toMatchObject({ on: 'air', thrower: 0 });
  });

  test('rolls a grab back that another player was faster with', () => {
    const { ann, ben, begin, pass, people } = threeTogether();
    begin();
    // A ball in the middle that both reach.
    for (const person of [ann, ben]) person.place(atRack(1));
    pass(0.2);
    ann.grab(1);
    ben.grab(1);
    expect(ben.match.balls[1]).toEqual({ on: 'hand', player: 1, side: 'right' });
    pass(0.1);
    for (const { match } of people) expect(match.balls[1]).toEqual({ on: 'hand', player: 0, side: 'right' });
    expect(ben.happened('refused').map(({ reason }) => reason)).toEqual(['taken']);
    expect(ann.happened('refused')).toEqual([]);
  });

  test('plays a rematch with roles moved on when asked', () => {
    const { people, ann, begin, pass } = threeTogether({ ball: { seconds: 1 } });
    begin();
    pass(1.5);
    expect(ann.match.phase).toBe('over');
    ann.act({ type: 'rotate', rotate: true });
    for (const { connection } of people) connection.setReady(true);
    pass(0.2);
    for (const { match } of people) {
      expect(match.phase).toBe('running');
      expect(match.players.map(({ role }) => role)).toEqual(['thrower', 'holder', 'thrower']);
    }
    expect(ann.news.filter((word) => word === 'match')).toHaveLength(1);
  });

  test('a bot gives its seat to a person', () => {
    const host = createBallLoopbackHost();
    const bots = ['one', 'two', 'three'].map((name) => host.connect(visitor(name, { bot: true }), 1));
    expect(bots[0]?.room?.seats.map((row) => row?.bot)).toEqual([true, true, true]);
    const ann = host.connect(visitor('Ann'), 2);
    expect(ann.room?.mySeat).toBe(0);
    expect(bots[0]?.status).toMatchObject({ phase: 'ended', reason: 'yielded' });
    expect(ann.room?.seats.map((row) => row?.bot)).toEqual([false, true, true]);
  });

  test('the inputs of a match play it again to the same end', () => {
    const log: (readonly BallInput[])[] = [];
    const three = threeTogether({ stepped: (actions) => log.push(actions), seed: 7 });
    three.begin();
    for (const ball of [0, 1, 2]) three.throwBall(ball);
    three.pass(1.5);
    expect(three.host.room.match?.score).toBe(3);
    let state = ballRules.start(['seat 0', 'seat 1', 'seat 2'], 7);
    for (const actions of log) state = ballRules.step(state, actions).state;
    expect(state).toEqual(three.host.room.match);
  });
});
