import { nothingPressed } from 'threepoint/core';
import { createBallLoopbackHost } from 'threepoint-games/ball';
import type { ConnectionStatus } from 'threepoint-rooms/room';
import { expect, test } from 'vitest';
import { ballGame } from '../../../src/page/ball/ball-game';
import { matchRound } from '../../../src/page/people/panel/match-round';
import { ballPage } from '../playing';

test('a panel describes the connection only while it stands, and waits for nobody without it', () => {
  const play = ballPage(createBallLoopbackHost());
  for (const time of [1, 2]) play.begin(time);
  const frame = play.follow(2, null, nothingPressed);
  const { room } = play;
  if (!frame || !room) throw new Error('Robin is not in the room');
  const described = (status: ConnectionStatus) => {
    const { connection, waiting, joined, ended } = matchRound(ballGame, {
      play: { status, room: { ...room, responseTime: 0.008 } },
      frame,
      readyByItself: false,
      voices: {
        state: {
          ...{ phase: 'none', muted: true, relay: false, relayOnly: false },
          ...{ message: null, microphoneMissing: false },
        },
        seats: { voiceOf: () => ({ voice: 'none', link: 'none', silenced: false, hidden: false }) },
      },
    });
    return { connection, waiting, joined, ended };
  };
  const status = { phase: 'joined', attempt: 0, retryIn: null, reason: null } as const;
  expect(described(status)).toEqual({
    connection: 'Connection good, 8 ms',
    waiting: 'Waiting for a basket holder.',
    joined: true,
    ended: null,
  });
  const nothing = { connection: null, waiting: null, joined: false, ended: null };
  expect(described({ ...status, phase: 'reconnecting', attempt: 1, retryIn: 2 })).toEqual(nothing);
  expect(described({ ...status, phase: 'ended', reason: 'left' })).toEqual({ ...nothing, ended: 'You left the room.' });
});
