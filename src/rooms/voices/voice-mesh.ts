import type { SignalBody } from '../protocol/voice-messages';
import { VoicePeer } from './voice-peer';

interface VoiceMeshOptions {
  readonly configuration: RTCConfiguration;
  signal(to: string, body: SignalBody): void;
  /** Called with the voice of the page with this session; null: it has ended. */
  onStream(session: string, stream: MediaStream | null): void;
}

/** The peer connections to all other voices of a room, by voice session. */
export class VoiceMesh {
  readonly #options: VoiceMeshOptions;
  readonly #peers = new Map<string, VoicePeer>();
  #configuration: RTCConfiguration;
  #track: MediaStreamTrack | null = null;

  constructor(options: VoiceMeshOptions) {
    this.#options = options;
    this.#configuration = options.configuration;
  }

  /** Applies other ICE servers or credentials to all connections, which continue meanwhile. */
  configure(configuration: RTCConfiguration): void {
    this.#configuration = configuration;
    for (const peer of this.#peers.values()) peer.configure(configuration);
  }

  /** Connects the page of session `own` to exactly these others; null: closes all connections. */
  connectTo(own: string | null, others: readonly string[]): void {
    for (const session of this.#peers.keys()) {
      if (own === null || !others.includes(session)) this.#drop(session);
    }
    if (own === null) return;
    for (const session of others) {
      if (!this.#peers.has(session)) this.#peers.set(session, this.#connect(own, session));
    }
  }

  /** Handles a signal; ignores one from an unknown session. */
  receive(from: string, body: SignalBody): void {
    void this.#peers.get(from)?.receive(body);
  }

  /** Sends the own voice to all; null: sends nothing. */
  setTrack(track: MediaStreamTrack | null): void {
    this.#track = track;
    for (const peer of this.#peers.values()) peer.setTrack(track);
  }

  /** Restarts lost connections at this time [s]. `reachable`: whether the room receives signals. */
  restartLost(now: number, reachable: boolean): void {
    for (const peer of this.#peers.values()) peer.restartIfLost(now, reachable);
  }

  /** Returns the state of the connection to a session; null: there is none. */
  stateOf(session: string): RTCPeerConnectionState | null {
    return this.#peers.get(session)?.state ?? null;
  }

  close(): void {
    this.connectTo(null, []);
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
