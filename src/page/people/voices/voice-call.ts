import type { SignalBody } from 'threepoint-rooms/internal';
import { VoiceMesh } from 'threepoint-rooms/internal';
import { VoiceSound } from '../../scene/sound/voice-sound';

export interface VoiceCallOptions {
  /** The audio that the game's own sounds play in. */
  readonly context: AudioContext;
  readonly configuration: RTCConfiguration;
  /** Sends a signal to the page of this session. */
  signal(to: string, body: SignalBody): void;
  /** This page has another session now: other pages must be notified. */
  onSession(): void;
  /** The voice of this session is playing. */
  onVoice(session: string): void;
}

const newSession = (): string => {
  const bytes = crypto.getRandomValues(new Uint8Array(8));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, '0')).join('');
};

/**
 * The user's part in the voices of a room, from joining to leaving: connections to other pages and the sound of their
 * voices.
 */
export class VoiceCall {
  readonly #options: VoiceCallOptions;
  readonly mesh: VoiceMesh;
  readonly sound: VoiceSound;
  /** The sessions that this page is connected to. */
  readonly #linked = new Set<string>();
  /** The sessions that this page has disconnected from. */
  readonly #dropped = new Set<string>();
  #session = newSession();

  constructor(options: VoiceCallOptions) {
    const { context, configuration, signal } = options;
    this.#options = options;
    this.sound = new VoiceSound(context);
    this.mesh = new VoiceMesh({ configuration, signal, onStream: (session, stream) => this.#play(session, stream) });
  }

  /** The name of this page among the voices. Both pages of a connection need a new one to reconnect. */
  get session(): string {
    return this.#session;
  }

  /**
   * Connects to the pages of these sessions and disconnects from all others. `seated`: the user has a seat; `moved`:
   * another one than before.
   */
  connect(sessions: readonly (string | null)[], seated: boolean, moved: boolean): void {
    const others = seated ? sessions.filter((session) => session !== null) : [];
    // The other page may have kept its half of a connection that was closed here. A new session makes it close that
    // too.
    if (seated && (moved || others.some((session) => this.#dropped.has(session)))) {
      this.mesh.close();
      this.#linked.clear();
      this.#dropped.clear();
      this.#session = newSession();
      this.#options.onSession();
    }
    for (const session of this.#linked) if (!others.includes(session)) this.#dropped.add(session);
    this.#linked.clear();
    for (const session of others) this.#linked.add(session);
    this.mesh.connectTo(seated ? this.#session : null, others);
  }

  /** Sends this track to the others; null: sends nothing. */
  setTrack(track: MediaStreamTrack | null): void {
    this.mesh.setTrack(track);
    this.sound.setOwn(track);
  }

  /** All voices at the user's ears, and before distance and direction change them [dB of full scale]; −120: silence. */
  loudness(): { readonly loudness: number; readonly spokenLoudness: number } {
    return { loudness: this.sound.loudness(), spokenLoudness: this.sound.spokenLoudness() };
  }

  /** Repairs connections and sound. Call it twice a second. `joined`: this page is connected to the room. */
  watch(joined: boolean): void {
    const { context } = this.#options;
    this.mesh.restartLost(performance.now() / 1000, joined);
    // A headset's sleep suspends audio too.
    if (context.state === 'suspended' && document.visibilityState === 'visible') void context.resume();
    this.sound.restartFailed();
  }

  dispose(): void {
    this.mesh.close();
    this.sound.dispose();
  }

  #play(session: string, stream: MediaStream | null): void {
    if (!stream) {
      this.sound.remove(session);
      return;
    }
    this.sound.add(session, stream);
    this.#options.onVoice(session);
  }
}
