import { describe, expect, test } from 'vitest';
import { IceServerCache } from '../../../src/rooms/voices/ice-server-cache';
import type { VoiceSettings } from '../../../src/rooms/voices/voice-settings';

/** A server that gives numbered passes, each good for so long [s]; null: it has no relay. */
function serverOf(ttlSeconds: number | null) {
  const server = { asked: 0, answers: true, nowMs: 0 };
  const ask = async (): Promise<VoiceSettings> => {
    server.asked += 1;
    if (!server.answers) throw new Error('the server sent no voice settings (503)');
    return { voices: true, iceServers: [{ urls: 'turn:turn.example.org', username: `${server.asked}` }], ttlSeconds };
  };
  return { server, kept: new IceServerCache(ask, () => server.nowMs) };
}

const hour = 3600_000;
const passOf = (terms: VoiceSettings | null) => terms?.iceServers[0]?.username ?? null;

describe('a pass to a relay for voices', () => {
  test('is renewed after three of its four hours, once', async () => {
    const { server, kept } = serverOf(4 * 3600);
    await kept.refresh();
    server.nowMs = 2.9 * hour;
    expect(await kept.refreshIfDue()).toBeNull();
    server.nowMs = 3 * hour;
    const [first, second] = await Promise.all([kept.refreshIfDue(), kept.refreshIfDue()]);
    expect([passOf(first), second]).toEqual(['2', null]);
    expect(passOf(kept.newest)).toBe('2');
    server.nowMs = 5.9 * hour;
    expect(await kept.refreshIfDue()).toBeNull();
    server.nowMs = 6 * hour;
    expect(passOf(await kept.refreshIfDue())).toBe('3');
  });

  test('is asked for at once by a device that slept through the time', async () => {
    const { server, kept } = serverOf(4 * 3600);
    await kept.refresh();
    server.nowMs = 30 * hour;
    expect(passOf(await kept.refreshIfDue())).toBe('2');
  });

  test('stays while the server does not answer, which is asked again and not all the time', async () => {
    const { server, kept } = serverOf(4 * 3600);
    await kept.refresh();
    server.nowMs = 3 * hour;
    server.answers = false;
    for (let second = 0; second < 60; second++) {
      expect(await kept.refreshIfDue()).toBeNull();
      server.nowMs += 1000;
    }
    expect(server.asked).toBe(5);
    expect(passOf(kept.newest)).toBe('1');
    server.answers = true;
    server.nowMs += 15_000;
    expect(passOf(await kept.refreshIfDue())).toBe('6');
  });

  test('a missing one is never asked for again', async () => {
    const { server, kept } = serverOf(null);
    await kept.refresh();
    server.nowMs = 1000 * hour;
    expect(await kept.refreshIfDue()).toBeNull();
    expect(server.asked).toBe(1);
  });
});
