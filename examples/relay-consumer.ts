// The entry of threepoint-relay in TypeScript: compiled against the packed packages by `npm run test:full`.
import { createServer } from 'node:http';
import { type AttachedRooms, type AttachRoomsOptions, attachRooms } from 'threepoint-relay';

export async function serve(options: AttachRoomsOptions): Promise<number> {
  const rooms: AttachedRooms = attachRooms(createServer(), { path: '/bodies', seats: 4, ...options });
  const { players } = rooms.census;
  await rooms.close();
  return players;
}
