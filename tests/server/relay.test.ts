import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { atRack, fists, holding, opening, releaseOf } from '../net/people';
import { arrive, type RunningRelay, startRelay, until } from './running-relay';

let server: RunningRelay;
beforeAll(async () => {
  server = await startRelay();
});
afterAll(() => server.close());

describe('a relay', () => {
  test('three people over sockets play a ball into the basket and agree', async () => {
    const people = ['Ann', 'Ben', 'Cal'].map((name) => arrive(server.url, 'game', name));
    const [ann, ben, cal] = people as [(typeof people)[0], (typeof people)[0], (typeof people)[0]];
    try {
      await until('all seats taken', () =>
        people.every(({ connection }) => connection.room?.seats.every((row) => row !== null)),
      );
      for (const person of people) {
        if (person.seat === 2) person.place(holding(opening));
        else person.place(fists(releaseOf(person.seat)));
        person.connection.ready(true);
      }
      await until('the match running', () => people.every(({ match }) => match.phase === 'running'));
      const thrower = people.find(({ seat }) => seat === 0)!;
      thrower.place(atRack(0));
      await until('the fist at the rack', () => server.relay.host.room('game')?.match?.players[0]?.right?.y === 0.925);
      thrower.grab(0);
      await until('the ball in hand', () => people.every(({ match }) => match.balls[0]?.on === 'hand'));
      thrower.place(fists(releaseOf(0)));
      await until('the hand up', () => server.relay.host.room('game')?.match?.players[0]?.right?.y === 1.6);
      thrower.toss(0, thrower.now());
      await until('a point', () => people.every(({ match }) => match.score === 1), 5);
      for (const { match } of [ann, ben, cal]) expect(match.balls[0]).toEqual({ on: 'basket', thrower: 0 });
      expect(new Set(ann.poses.map(({ seat }) => seat)).size).toBe(2);
    } finally {
      for (const person of people) person.stop();
    }
  });
});
