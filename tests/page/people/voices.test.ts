import { createBallLoopbackHost } from 'threepoint-games/ball';
import type { VoiceSettings } from 'threepoint-rooms/internal';
import { beforeEach, describe, expect, test, vi } from 'vitest';
import { BlockList } from '../../../src/page/people/voices/block-list';
import { Voices } from '../../../src/page/people/voices/voices';
import { visitor } from '../../rooms/client/people';

const told: VoiceSettings = { voices: true, iceServers: [], ttlSeconds: null };

/** What the browser has of a microphone: each question waits for its answer. */
const device = { questions: [] as (() => void)[], live: 0 };

class Track extends EventTarget {
  enabled = true;
  #live = true;

  constructor() {
    super();
    device.live += 1;
  }

  stop(): void {
    if (this.#live) device.live -= 1;
    this.#live = false;
  }
}

function getUserMedia(): Promise<unknown> {
  return new Promise((resolve) => {
    device.questions.push(() => {
      const track = new Track();
      resolve({ getAudioTracks: () => [track], getTracks: () => [track] });
    });
  });
}

beforeEach(() => {
  vi.stubGlobal('navigator', { mediaDevices: { getUserMedia } });
  vi.stubGlobal('document', Object.assign(new EventTarget(), { visibilityState: 'visible' }));
  Object.assign(device, { questions: [], live: 0 });
});

/** Lets all that waits for nothing outside of the page go on. */
const settle = () => new Promise((resolve) => setImmediate(resolve));

/** A player in a room, whose server says what it has to say of voices when the test wants. */
function seated(spectate = false) {
  const play = createBallLoopbackHost().connect(visitor('Ann', { spectate }), 0);
  const answers: (() => void)[] = [];
  const voices = new Voices({
    client: { room: play.room, status: play.status, connection: play },
    blocked: new BlockList(),
    terms: () => new Promise((resolve) => answers.push(() => resolve(told))),
    // Nothing plays a sound here: no connection comes as far.
    openAudio: async () => ({}) as AudioContext,
    relayOnly: () => false,
  });
  return { voices, answers };
}

describe('a microphone', () => {
  test.each(['leave', 'dispose'] as const)(
    'is not asked for where the server answers after the player chose to %s',
    async (end) => {
      const { voices, answers } = seated();
      const joined = voices.join();
      voices[end]();
      answers[0]?.();
      await joined;
      expect(device.questions).toHaveLength(0);
      expect(voices.probe()).toMatchObject({ message: null });
    },
  );

  test.each(['leave', 'dispose'] as const)(
    'closes at once if it opens after the player chose to %s, and no one joins',
    async (end) => {
      const { voices, answers } = seated();
      const joined = voices.join();
      answers[0]?.();
      await settle();
      voices[end]();
      device.questions[0]?.();
      await joined;
      expect(device.live).toBe(0);
      expect(voices.state.phase).toBe('off');
      expect(voices.probe()).toMatchObject({ message: null });
    },
  );

  test('is not asked for again by a room that was left for good', async () => {
    const { voices, answers } = seated();
    voices.dispose();
    await voices.join();
    expect(answers).toHaveLength(0);
    expect(voices.probe().phase).not.toBe('joining');
  });

  test('is not asked for from a spectator, who learns first that only players talk', async () => {
    const { voices, answers } = seated(true);
    voices.ask(true);
    expect(voices.state).toMatchObject({ message: 'You are watching. Only players on the seats can talk.' });
    await voices.join();
    expect(answers).toHaveLength(0);
    expect(device.questions).toHaveLength(0);
    expect(voices.probe().phase).not.toBe('asked');
  });

  test('is requested once for a player who leaves and joins again, by the second join', async () => {
    const { voices, answers } = seated();
    const first = voices.join();
    voices.leave();
    void voices.join();
    answers[0]?.();
    await first;
    expect(device.questions).toHaveLength(0);
    answers[1]?.();
    await settle();
    expect(device.questions).toHaveLength(1);
    expect(voices.state.phase).toBe('joining');
    voices.dispose();
  });
});
