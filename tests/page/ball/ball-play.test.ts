import { allReleased, type Buttons, createEstimator, defaultCalibration, unknownFingers } from 'threepoint/core';
import { distance } from 'threepoint/math';
import { type BallEvent, type BallState, type BallSteering, createBallLoopbackHost } from 'threepoint-games/ball';
import { describe, expect, it } from 'vitest';
import { poseOf } from '../../threepoint/core/estimation/drawn';
import { ballPage } from '../playing';

/** Half of what a headset draws: every frame costs a solved body for each player. */
const usualHz = 36;
const released: Buttons = { left: allReleased, right: allReleased };

/** One page with a room of its own, frame by frame at 36 Hz; `acting`: the built-in player has the own seat. */
function page(options: {
  acting?: boolean;
  bots?: boolean;
  seat?: number;
  spectate?: boolean;
  ball?: Partial<BallState['options']>;
  rateHz?: number;
  steering?: () => BallSteering | null;
  host?: ReturnType<typeof createBallLoopbackHost>;
}) {
  const { acting = true, bots = true, ball = {}, rateHz = usualHz } = options;
  const host = options.host ?? createBallLoopbackHost({ seed: 3, ball });
  const { seat, spectate, steering = () => null } = options;
  const readyByItself = () => acting && !steering();
  const player = ballPage(host, { seat, spectate, bots: () => bots, readyByItself, steering, seed: 7 });
  const estimator = createEstimator('ik', defaultCalibration);
  const events: BallEvent[] = [];
  let time = 10;
  const frame = () => {
    time += 1 / rateHz;
    player.begin(time);
    const performed = acting ? player.act(time) : null;
    const seen = player.follow(time, performed?.frame ?? null, performed?.buttons ?? released);
    events.push(...(seen?.events ?? []));
    if (performed) player.sendPose(performed.frame.time, poseOf(estimator, performed.frame), unknownFingers);
    return seen;
  };
  return {
    player,
    host,
    events,
    frame,
    until(condition: () => boolean, seconds: number) {
      const end = time + seconds;
      while (!condition()) {
        if (time > end) throw new Error(`still not after ${seconds} s: ${JSON.stringify(player.probe())}`);
        frame();
      }
    },
  };
}

describe('one person with two bots', () => {
  for (const seat of [0, 1, 2]) {
    it(`plays a whole match from seat ${seat}, all through the same Room`, { tags: seat === 0 ? [] : ['full'] }, () => {
      const { player, until, events } = page({ seat });
      until(() => player.probe()?.phase === 'over', 110);
      const { score, end, ballsLeft, people } = player.probe() ?? {};
      expect({ end, ballsLeft }).toEqual({ end: 'balls', ballsLeft: 0 });
      expect(score).toBeGreaterThanOrEqual(12);
      expect(people?.filter((person) => person?.bot)).toHaveLength(2);
      expect(events.filter(({ type }) => type === 'caught')).toHaveLength(score ?? -1);
      expect(events.filter(({ type }) => type === 'refused')).toEqual([]);
    });
  }

  it('sees their bodies where their seats are, and the basket in the holder’s hands', () => {
    const { player, until } = page({ seat: 0 });
    until(() => player.newest?.bodies.length === 2, 10);
    const { bodies, opening, palms, state } = player.newest ?? {};
    expect(bodies?.map(({ id }) => id)).toEqual([1, 2]);
    expect(state?.players[2]?.role).toBe('holder');
    for (const side of ['left', 'right'] as const) {
      // The fists are 0.23 m from the middle, palms on the rim; a ball would lie in the palms, 6.5 cm further in.
      const palm = palms?.[2]?.[side];
      expect(palm && opening && distance(palm, opening.position)).toBeCloseTo(0.165, 2);
    }
    // Own floor frame: the other thrower stands 1.6 m to the right, the holder 5 m away.
    const [beside, ahead] = bodies ?? [];
    expect(beside?.placement.position.x).toBeCloseTo(1.6, 6);
    expect(Math.hypot(ahead?.placement.position.x ?? 0, ahead?.placement.position.z ?? 0)).toBeCloseTo(5, 6);
  });

  it('a person who plays by hand is asked; the built-in player is ready by itself', () => {
    const waiting = page({ acting: false });
    for (let i = 0; i < 5 * usualHz; i++) waiting.frame();
    expect(waiting.player.probe()).toMatchObject({ phase: 'ready', ready: false });
    waiting.player.connection?.setReady(true);
    waiting.until(() => waiting.player.probe()?.phase === 'running', 3);
  });

  it('plays again when all are ready, with roles moved on if asked', { tags: ['full'] }, () => {
    const { player, until } = page({ seat: 0, ball: { balls: 2, seconds: 20 } });
    until(() => player.probe()?.phase === 'over', 40);
    expect(player.probe()?.role).toBe('thrower');
    player.setOption(true);
    until(() => player.probe()?.phase === 'running', 20);
    expect(player.probe()?.score).toBe(0);
    const first = player.probe()?.role;
    until(() => player.probe()?.phase === 'over', 40);
    until(() => player.probe()?.phase === 'running', 20);
    const second = player.probe()?.role;
    expect([first, second]).toContain('holder');
  });

  it('a spectator has no seat and sees three bots play', () => {
    const { player, until } = page({ spectate: true, acting: false, ball: { balls: 4, seconds: 30 } });
    until(() => player.probe()?.phase === 'over', 60);
    expect(player.probe()).toMatchObject({ seat: null, role: null });
    expect(player.newest?.bodies).toHaveLength(3);
  });

  it('built-in players throw as often at 5, 10 and 60 pictures a second', { tags: ['full'] }, () => {
    const played = [5, 10, 60].map((rateHz) => {
      const { player, until, events } = page({ seat: 0, rateHz });
      until(() => player.probe()?.phase === 'over', 110);
      const happened = (type: BallEvent['type']) => events.filter((event) => event.type === type).length;
      return {
        thrown: happened('thrown'),
        refused: happened('refused'),
        secondsLeft: player.probe()?.secondsLeft ?? 0,
      };
    });
    for (const { thrown, refused, secondsLeft } of played) {
      expect({ thrown, refused }).toEqual({ thrown: 20, refused: 0 });
      expect(Math.abs(secondsLeft - (played[2]?.secondsLeft ?? 0))).toBeLessThan(1.5);
    }
  });

  it('stands still in a pause, and the match goes on afterwards unchanged', () => {
    const { player, until, events, frame } = page({ seat: 0 });
    until(() => (player.probe()?.ballsLeft ?? 20) < 18, 30);
    player.connection?.setPaused(true);
    until(() => player.probe()?.paused === true, 1);
    frame();
    const { secondsLeft, score } = player.probe() ?? {};
    const heard = events.length;
    const where = player.newest?.bodies.map(({ pose }) => pose.head.position);
    for (let i = 0; i < 20 * usualHz; i++) frame();
    expect(player.probe()).toMatchObject({ paused: true, secondsLeft, score, held: { left: null, right: null } });
    expect(events.length).toBe(heard);
    player.newest?.bodies.forEach(({ pose }, i) => {
      expect(distance(pose.head.position, where?.[i] ?? pose.head.position)).toBeLessThan(0.05);
    });
    player.setOption(true);
    frame();
    player.connection?.setPaused(false);
    until(() => player.probe()?.phase === 'over', 110);
    expect(player.probe()).toMatchObject({ end: 'balls', ballsLeft: 0, rotate: true });
    expect(events.filter(({ type }) => type === 'thrown')).toHaveLength(20);
    expect(events.filter(({ type }) => type === 'refused')).toEqual([]);
  });

  it.each([72, 5])('at %i pictures a second a mouse replaces the built-in player, throws, and hands back', (rateHz) => {
    const mouse = { on: false, pressed: false };
    const ray = { origin: { x: -0.8, y: 2, z: 3.5 }, direction: { x: 0.11, y: -0.11, z: -0.988 } };
    const steering = () => (mouse.on ? { ray, pressed: mouse.pressed, cancelled: false } : null);
    const { player, until, events } = page({ seat: 0, rateHz, steering, ball: { seconds: 600 } });
    until(() => player.probe()?.phase === 'running', 30);
    until(() => player.probe()?.held.left !== null || player.probe()?.held.right !== null, 10);
    mouse.on = true;
    const mine = () => events.filter((event) => event.type === 'thrown' && event.player === 0).length;
    const before = mine();
    // Pressed before there is a ball to throw: it counts from then on.
    mouse.pressed = true;
    until(() => (player.probe()?.aim ?? 0) > 5.5, 5);
    expect(mine()).toBe(before);
    mouse.pressed = false;
    until(() => mine() === before + 1, 3);
    expect(player.probe()?.aim).toBeNull();
    mouse.on = false;
    until(() => mine() === before + 2, 10);
    expect(events.filter(({ type }) => type === 'refused')).toEqual([]);
  });

  it('the bots of a hidden page give their seats to those of another person’s page', () => {
    const ann = page({ seat: 0 });
    const names = () => ben.player.probe()?.people.map((person) => person && `${person.name} ${person.presence}`);
    ann.until(() => ann.player.probe()?.people.every(Boolean) ?? false, 10);
    const ben = page({ seat: 1, host: ann.host });
    const both = (seconds: number) => {
      for (let i = 0; i < seconds * usualHz; i++) for (const each of [ann, ben]) each.frame();
    };
    both(2);
    expect(ann.player.probe()?.people).toMatchObject([{ bot: false }, { bot: false }, { bot: true }]);
    ann.player.away(true);
    ben.until(() => ben.player.newest?.bodies.some(({ id }) => id === 2) ?? false, 4);
    for (let i = 0; i < 4 * usualHz; i++) ben.frame();
    expect(names()).toEqual(['Robin away', 'Robin here', 'Kim here']);
    expect(ben.player.newest?.bodies.map(({ id }) => id)).toEqual([2]);
    ann.player.away(false);
    both(1);
    expect(names()).toEqual(['Robin here', 'Robin here', 'Kim here']);
  });

  it('the bots of a page that is hidden keep their seats while no other person plays', () => {
    const { player, until, frame } = page({ seat: 0 });
    until(() => player.probe()?.people.every(Boolean) ?? false, 10);
    player.away(true);
    for (let i = 0; i < usualHz; i++) frame();
    expect(player.probe()?.people.filter(Boolean)).toHaveLength(3);
  });

  it('bots go when they are not wanted', () => {
    const alone = page({ bots: false });
    for (let i = 0; i < 3 * usualHz; i++) alone.frame();
    expect(alone.player.probe()?.people.filter(Boolean)).toHaveLength(1);
  });
});
