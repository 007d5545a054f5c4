// A room client without a page, as a separate process: Playwright's loader does not load what it imports.
import { createHash } from 'node:crypto';
import { createAvatarExchange } from '../../src/rooms/client/avatar-exchange';
import { arrive, until } from '../../tests/relay/running-relay';

export interface GuestOrder {
  readonly id: number;
  /** The avatar file to wear; null: ask the server for the hash of the last one. */
  readonly file: Uint8Array<ArrayBuffer> | null;
}
export interface GuestAnswer {
  readonly id: number;
  /** The hash of the file that is worn or was asked for; null: the server has none. */
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
  person.connection.setAvatar(hash);
  return { hash };
}

process.on('message', (order: GuestOrder) => {
  follow(order).then(
    (done) => process.send?.({ id: order.id, ...done } satisfies GuestAnswer),
    (error: Error) => process.send?.({ id: order.id, hash: null, refused: error.message } satisfies GuestAnswer),
  );
});
// The client leaves at once, so that its seat is free for the next one.
process.on('disconnect', () => {
  person.stop();
  setTimeout(() => process.exit(0), 100);
});
process.send?.({ id: 0, hash: null } satisfies GuestAnswer);
