import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { Microphone } from '../../../src/rooms/voices/microphone';

/**
 * A track as a browser's: an event target that can be stopped; `end`: the device ends it, as a headset does that
 * sleeps.
 */
class Track extends EventTarget {
  stopped = false;
  muted = false;

  stop(): void {
    this.stopped = true;
  }

  /** The system mutes or unmutes the microphone, by a key of the device or its menu. */
  mute(muted: boolean): void {
    this.muted = muted;
    this.dispatchEvent(new Event(muted ? 'mute' : 'unmute'));
  }

  end(): void {
    this.dispatchEvent(new Event('ended'));
  }
}

/** What the browser has of a microphone: gives a new track each time, or refuses by this name. */
const device = { asked: 0, refuses: null as string | null, tracks: [] as Track[] };
const seen = Object.assign(new EventTarget(), { visibilityState: 'visible' });

const open: Microphone[] = [];

function getUserMedia(): Promise<unknown> {
  device.asked += 1;
  if (device.refuses) return Promise.reject(new DOMException('no', device.refuses));
  const track = new Track();
  device.tracks.push(track);
  return Promise.resolve({ getAudioTracks: () => [track], getTracks: () => [track] });
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal('navigator', { mediaDevices: { getUserMedia } });
  vi.stubGlobal('document', seen);
  Object.assign(device, { asked: 0, refuses: null, tracks: [] });
  seen.visibilityState = 'visible';
});
afterEach(() => {
  for (const microphone of open.splice(0)) microphone.close();
  vi.useRealTimers();
});

async function opened() {
  const tracks: unknown[] = [];
  const microphone: Microphone = new Microphone(() => tracks.push(microphone.track));
  open.push(microphone);
  await microphone.open();
  return { microphone, tracks };
}

describe('a microphone that a headset ends when it sleeps', () => {
  test('is taken again at once where the page is visible, and counted lost until then', async () => {
    const { microphone, tracks } = await opened();
    device.tracks[0]?.end();
    expect(microphone.track).toBeNull();
    expect(microphone.errorMessage).toBe(
      'The microphone was disconnected. Connect it again; the page is looking for it.',
    );
    await vi.advanceTimersByTimeAsync(0);
    expect(microphone.track).toBe(device.tracks[1]);
    expect(microphone.errorMessage).toBeNull();
    expect(tracks).toEqual([device.tracks[0], null, device.tracks[1]]);
  });

  test('is requested when the page is visible again, and every two seconds until it returns', async () => {
    const { microphone } = await opened();
    seen.visibilityState = 'hidden';
    device.refuses = 'NotReadableError';
    device.tracks[0]?.end();
    await vi.advanceTimersByTimeAsync(60_000);
    expect(device.asked).toBe(1);
    seen.visibilityState = 'visible';
    seen.dispatchEvent(new Event('visibilitychange'));
    await vi.advanceTimersByTimeAsync(1);
    expect(device.asked).toBe(2);
    expect(microphone.errorMessage).toMatch(/does not answer/);
    device.refuses = null;
    await vi.advanceTimersByTimeAsync(2000);
    expect(microphone.track).toBe(device.tracks[1]);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(device.asked).toBe(3);
  });

  test('is requested once where refused on return, with a sentence, then at its owner’s wish', async () => {
    const { microphone } = await opened();
    device.refuses = 'NotAllowedError';
    device.tracks[0]?.end();
    await vi.advanceTimersByTimeAsync(60_000);
    expect(microphone.errorMessage).toMatch(/blocks the microphone. Allow it next to the address/);
    expect(device.asked).toBe(2);
    device.refuses = null;
    await microphone.open();
    expect(microphone.track).toBe(device.tracks[1]);
    expect(microphone.errorMessage).toBeNull();
  });

  test('stays ended where its owner has left the voices meanwhile', async () => {
    const { microphone } = await opened();
    seen.visibilityState = 'hidden';
    device.tracks[0]?.end();
    microphone.close();
    seen.visibilityState = 'visible';
    seen.dispatchEvent(new Event('visibilitychange'));
    await vi.advanceTimersByTimeAsync(60_000);
    expect(device.asked).toBe(1);
  });
});

describe('a microphone that the system mutes', () => {
  test('is no track, with a sentence, and is the same track when the system unmutes it', async () => {
    const { microphone, tracks } = await opened();
    device.tracks[0]?.mute(true);
    expect(microphone.track).toBeNull();
    expect(microphone.errorMessage).toMatch(/^The system mutes the microphone/);
    device.tracks[0]?.mute(false);
    expect(microphone.track).toBe(device.tracks[0]);
    expect(microphone.errorMessage).toBeNull();
    expect(tracks).toEqual([device.tracks[0], null, device.tracks[0]]);
    expect(device.asked).toBe(1);
  });

  test('is released while it is muted, and reports nothing afterwards', async () => {
    const { microphone, tracks } = await opened();
    device.tracks[0]?.mute(true);
    microphone.close();
    expect(device.tracks[0]?.stopped).toBe(true);
    device.tracks[0]?.mute(false);
    expect(tracks).toHaveLength(2);
    expect(microphone.errorMessage).toBeNull();
  });
});
