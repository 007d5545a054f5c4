import { unknownFingers } from 'threepoint/core';
import { identity, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { LoopbackHost } from '../../../src/rooms/client/loopback-host';
import { RoomClient } from '../../../src/rooms/client/room-client';
import { countingClientPolicy, countingPolicy } from '../room/counting-game';
import { visitor } from './people';

/** A room of two seats in this page, in frames at 30 Hz. */
function roomOfTwo() {
  const host = new LoopbackHost(countingPolicy(2), countingClientPolicy);
  let time = 10;
  const join = (name: string) => new RoomClient((now) => host.connect(visitor(name), now));
  type Person = ReturnType<typeof join>;
  const frame = (clients: readonly Person[], places: ReadonlyMap<Person, number>) => {
    time += 1 / 30;
    for (const client of clients) {
      client.update(time);
      const x = places.get(client);
      if (x === undefined) continue;
      const head = { position: vec3(x, 1.6, 0), orientation: identity, tracking: 'tracked' } as const;
      client.sendPose(time, { head, leftHand: null, rightHand: null, body: null }, unknownFingers);
    }
  };
  return { join, frame };
}

test('a person who takes the seat of another is never drawn between the two', () => {
  const { join, frame } = roomOfTwo();
  const [ann, ben, cal] = [join('Ann'), join('Ben'), join('Cal')];
  for (let i = 0; i < 30; i++) frame([ann, ben], new Map([[ben, 3]]));
  expect(ann.people.map(({ id, pose }) => [id, pose.head.position.x])).toEqual([[1, expect.closeTo(3, 3)]]);
  ben.connection?.leave();
  const drawn: number[] = [];
  for (let i = 0; i < 60; i++) {
    frame([ann, cal], new Map([[cal, -3]]));
    drawn.push(...ann.people.map(({ pose }) => pose.head.position.x));
  }
  expect(drawn.at(-1)).toBeCloseTo(-3, 3);
  expect(drawn.filter((x) => Math.abs(Math.abs(x) - 3) > 0.001)).toEqual([]);
});

test('the floors of others are placed in the own seat’s, and in the arena for spectators', () => {
  const { join, frame } = roomOfTwo();
  const [ann, ben, zoe] = [join('Ann'), join('Ben'), join('Zoe')];
  for (let i = 0; i < 30; i++) frame([ann, ben, zoe], new Map([ann, ben].map((client) => [client, 0])));
  const heights = (client: typeof ann) => client.people.map(({ placement }) => placement.position.y);
  // The floor of seat 1 lies a metre above that of seat 0.
  expect([heights(ann), heights(ben), heights(zoe)]).toEqual([[1], [-1], [0, 1]]);
});
