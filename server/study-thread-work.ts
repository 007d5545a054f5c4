import { parentPort } from 'node:worker_threads';
import { RoomTokens } from 'threepoint-relay';
import { serveStudies } from 'threepoint-study/server';

// The thread of the studies: its seats are signed by the tokens that the rooms of this server accept.

if (!parentPort) throw new Error('study-thread-work.ts runs in a worker thread, which the study service starts');
serveStudies(parentPort, (secret, now) => {
  const tokens = new RoomTokens(secret, now);
  return (pass) => tokens.sign(pass);
});
