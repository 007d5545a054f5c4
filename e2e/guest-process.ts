// A person in a room without a page, as a process of its own: what this one imports, Playwright's loader does not read.
import { createHash } from 'node:crypto';
import { createAvatarExchange } from 'threepoint-rooms/client/avatar-exchange';
import { arrive, until } from '../tests/rooms/server/running-relay';

export interface GuestOrder {
  readonly id: number;
  /** A file to be put on; null: to be asked whether the server still has the last one. */
  readonly file: Uint8Array<ArrayBuffer> | null;
}
export interface GuestAnswer {
  readonly id: number;
  /** Of the file that is on, or was asked for; null: the server has none. */
  readonly hash: string | null;
  readonly refused?: string;
}

const [origin, room, name] = process.argv.slice(2) as [string, string, string];
const person = arrive(origin, room, name);
await until(`${name} in`, () => person.connection.room !== null);
const exchange = createAvatarExchange(origin, room, person.pass);

async function follow({ file }: GuestOrder): Promise<Omit<GuestAnswer, 'id'>> {
  if (!file) return { hash: (await exchange.terms()).yours };
  const hash = createHash('sha256').update(file).digest('base64url');
  await exchange.store(hash, new Blob([file]));
  person.connection.wear(hash);
  return { hash };
}

process.on('message', (order: GuestOrder) => {
  follow(order).then(
    (done) => process.send?.({ id: order.id, ...done } satisfies GuestAnswer),
    (error: Error) => process.send?.({ id: order.id, hash: null, refused: error.message } satisfies GuestAnswer),
  );
});
// Its seat is free for the next one at once.
process.on('disconnect', () => {
  person.stop();
  setTimeout(() => process.exit(0), 100);
});
process.send?.({ id: 0, hash: null } satisfies GuestAnswer);
