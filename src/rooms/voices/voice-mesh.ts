import type { SignalBody } from '../protocol/voice-messages';
import { VoicePeer } from './voice-peer';

export interface VoiceMeshOptions {
  readonly configuration: RTCConfiguration;
  signal(to: string, body: SignalBody): void;
  /** The voice of the page with this session; null: it is there no longer. */
  onStream(session: string, stream: MediaStream | null): void;
}

/** Connections to all others who take part in the voices of a room, each by the session that its page has among them. */
export class VoiceMesh {
  readonly #options: VoiceMeshOptions;
  readonly #peers = new Map<string, VoicePeer>();
  #configuration: RTCConfiguration;
  #track: MediaStreamTrack | null = null;

  constructor(options: VoiceMeshOptions) {
    this.#options = options;
    this.#configuration = options.configuration;
  }

  /** Other servers, or another pass to the same, for all connections: each is taken to them while it goes on. */
  configure(configuration: RTCConfiguration): void {
    this.#configuration = configuration;
    for (const peer of this.#peers.values()) peer.configure(configuration);
  }

  /** Connects the page of session `own` to these others and to no one else; null: it is not among them itself. */
  follow(own: string | null, others: readonly string[]): void {
    for (const session of this.#peers.keys()) {
      if (own === null || !others.includes(session)) this.#drop(session);
    }
    if (own === null) return;
    for (const session of others) {
      if (!this.#peers.has(session)) this.#peers.set(session, this.#connect(own, session));
    }
  }

  /** Takes in a signal; from a page that is not among the voices, nothing. */
  receive(from: string, body: SignalBody): void {
    void this.#peers.get(from)?.receive(body);
  }

  /** The own voice, to all; null: nothing is sent. */
  setTrack(track: MediaStreamTrack | null): void {
    this.#track = track;
    for (const peer of this.#peers.values()) peer.setTrack(track);
  }

  /** Looks after all connections, at this time [s]; `reachable`: signals arrive at the room. */
  watch(now: number, reachable: boolean): void {
    for (const peer of this.#peers.values()) peer.watch(now, reachable);
  }

  /** How it stands with a page; null: there is no connection to it. */
  stateOf(session: string): RTCPeerConnectionState | null {
    return this.#peers.get(session)?.state ?? null;
  }

  close(): void {
    this.follow(null, []);
  }

  #connect(own: string, session: string): VoicePeer {
    const { signal, onStream } = this.#options;
    return new VoicePeer(
      {
        polite: own < session,
        configuration: this.#configuration,
        signal: (body) => signal(session, body),
        onStream: (stream) => onStream(session, stream),
      },
      this.#track,
    );
  }

  #drop(session: string): void {
    this.#peers.get(session)?.close();
    this.#peers.delete(session);
    this.#options.onStream(session, null);
  }
}
