import { expect, test, vi } from 'vitest';
import { VoiceSound } from '../../../src/page/scene/sound/voice-sound';

class Node {
  connect(next: Node): Node {
    return next;
  }

  disconnect(): void {
    // Nothing here makes a sound.
  }
}

/** What a browser has of audio, as far as the own level needs it. */
function listening() {
  const made: MediaStream[] = [];
  const context = {
    currentTime: 0,
    destination: new Node(),
    createGain: () => new Node(),
    createAnalyser: () => Object.assign(new Node(), { getFloatTimeDomainData: (into: Float32Array) => into.fill(0.5) }),
    createMediaStreamSource(stream: MediaStream) {
      made.push(stream);
      return new Node();
    },
  };
  vi.stubGlobal('MediaStream', class {});
  return { sound: new VoiceSound(context as unknown as AudioContext), made };
}

const track = () => ({}) as MediaStreamTrack;

test('a microphone that is muted and unmuted a hundred times has one source', () => {
  const { sound, made } = listening();
  const own = track();
  for (let i = 0; i < 100; i++) {
    sound.setOwn(own);
    expect(sound.ownLevel()).toBeGreaterThan(0.5);
    sound.setOwn(null);
    expect(sound.ownLevel()).toBe(0);
  }
  expect(made).toHaveLength(1);
  sound.setOwn(track());
  expect(made).toHaveLength(2);
});
