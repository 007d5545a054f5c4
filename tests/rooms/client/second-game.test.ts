import { expect, onTestFinished, test } from 'vitest';
import type { Connection } from '../../../src/rooms/client/connection';
import { LoopbackHost } from '../../../src/rooms/client/loopback-host';
import { createRoomPass } from '../../../src/rooms/client/room-pass';
import { SocketConnection } from '../../../src/rooms/client/socket-connection';
import { until } from '../../relay/running-relay';
import { relayOfTest } from '../../relay/until-finished';
import { type CountingGame, countingClientPolicy, countingKind, countingPolicy } from '../room/counting-game';
import { visitor } from './people';

interface Counter {
  readonly connection: Connection<CountingGame>;
  /** The totals that the Room reported, in their order. */
  readonly totals: number[];
  frame(): void;
}

test('a client follows a game that its session does not know: events, refusals, predictions, places', () => {
  const host = new LoopbackHost(countingPolicy(2), countingClientPolicy);
  let time = 10;
  const [ann, ben] = ['Ann', 'Ben'].map((name) => host.connect(visitor(name), time)) as [
    ReturnType<typeof host.connect>,
    ReturnType<typeof host.connect>,
  ];
  const frame = () => {
    time += 0.1;
    return [ann.update(time), ben.update(time)].map(({ events }) => events);
  };
  for (const person of [ann, ben]) person.setReady(true);
  frame();
  frame();
  expect(host.room.match.phase).toBe('running');

  ann.sendAction({ type: 'count', to: 1 });
  // The Room has not stepped yet: the player sees the own action, the other player does not.
  expect([ann.room?.match?.total, ben.room?.match?.total]).toEqual([1, 0]);
  ben.sendAction({ type: 'count', to: 7 });
  const heard = [frame(), frame(), frame()];
  expect(heard.flatMap(([, ofBen]) => ofBen)).toContainEqual({ type: 'counted', player: 0, total: 1 });
  expect(heard.flatMap(([, ofBen]) => ofBen)).toContainEqual({ type: 'refused', player: 1, reason: 'not-next' });
  expect(heard.flatMap(([ofAnn]) => ofAnn ?? []).map(({ type }) => type)).toEqual(['counted']);
  expect([ann.room?.match?.total, ben.room?.match?.total]).toEqual([1, 1]);
  expect(ben.arenaFromFloor(1).position.y).toBe(1);
});

test('a whole round of it is played over a relay by the ball game’s client', async () => {
  const relay = await relayOfTest();
  const room = `${countingKind}-over-sockets`;
  const [ann, ben] = ['Ann', 'Ben'].map((name) => {
    const pass = createRoomPass(relay.url, room, countingKind);
    const connection: Connection<CountingGame> = new SocketConnection(countingClientPolicy, {
      ...{ url: relay.url, room, pass },
      visitor: visitor(name),
    });
    const totals: number[] = [];
    return {
      connection,
      totals,
      frame() {
        for (const event of connection.update(performance.now() / 1000).events)
          if (event.type === 'counted') totals.push(event.total);
      },
    };
  }) as [Counter, Counter];
  const people = [ann, ben];
  onTestFinished(() => {
    for (const { connection } of people) connection.leave();
  });
  const frames = (isTrue: () => boolean) => () => {
    for (const person of people) person.frame();
    return isTrue();
  };
  await until(
    'both players sit',
    frames(() => people.every(({ connection }) => connection.room?.mySeat != null)),
  );
  for (const { connection } of people) connection.setReady(true);
  for (const [index, to] of [1, 2, 3].entries()) {
    const { connection } = people[index % 2] as Counter;
    await until(`the number ${to} is counted`, () => {
      // Before the match runs, the Room refuses what a player counts.
      if (ann.totals.length < to && connection.room?.match?.total !== to) connection.sendAction({ type: 'count', to });
      return frames(() => people.every(({ totals }) => totals.includes(to)))();
    });
  }
  for (const { totals } of people) expect(totals).toEqual([1, 2, 3]);
});
