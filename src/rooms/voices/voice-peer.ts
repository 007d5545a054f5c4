import { isPassableCandidate, maxCandidates, maxDescriptionLength, type SignalBody } from '../protocol/voice-messages';

interface VoicePeerOptions {
  /** Whether this side yields when both make an offer; the other side makes the first offer. */
  readonly polite: boolean;
  readonly configuration: RTCConfiguration;
  signal(body: SignalBody): void;
  /** Called with the other voice, which lasts as long as the connection. */
  onStream(stream: MediaStream): void;
}

type Candidate = Extract<SignalBody, { candidates: unknown }>['candidates'][number];

/** ICE candidates that are found within this time [ms] are sent together. */
const gatherMs = 60;
/** An unanswered offer is sent again after this time [s]. */
const answerSeconds = 2;
/** Interval of ICE restarts of a lost connection [s], while the room is reachable. */
const restartSeconds = 2.5;
const longestCandidate = 300;
/**
 * A connection is closed after this delay [ms]. Chromium leaks a connection that is closed right after an answer: 9 to
 * 14 of 100 random ones, and at most one with this delay (Chromium 156).
 */
const closingMs = 250;

/**
 * Returns a description that fits into a message: without candidates if it is too long, because they are also sent
 * separately.
 */
function shortened(sdp: string): string {
  const passable = sdp.replace(/^a=(candidate.*)\r\n/gm, (text, candidate) =>
    isPassableCandidate(candidate) ? text : '',
  );
  return passable.length <= maxDescriptionLength
    ? passable
    : passable.replace(/^a=(candidate|end-of-candidates).*\r\n/gm, '');
}

/** Restricts a transceiver to Opus, which all browsers support: an offer with all codecs is three times as long. */
function opusAlone(transceiver: RTCRtpTransceiver): void {
  const codecs = RTCRtpReceiver.getCapabilities('audio')?.codecs ?? [];
  const opus = codecs.filter(({ mimeType }) => mimeType.toLowerCase() === 'audio/opus');
  // Older browsers cannot choose codecs.
  if (opus.length > 0) transceiver.setCodecPreferences?.(opus);
}

/**
 * A peer connection to one other page, which carries both voices. It uses perfect negotiation (WebRTC 1.0, section
 * 10.7): either page may make an offer, and if both do, the polite one rolls its own back.
 */
export class VoicePeer {
  readonly #options: VoicePeerOptions;
  readonly #pc: RTCPeerConnection;
  #closed = false;
  #offering = false;
  #ignoring = false;
  #answering = false;
  #track: MediaStreamTrack | null;
  #candidates: Candidate[] = [];
  #gathering: ReturnType<typeof setTimeout> | null = null;
  #offeredAt = 0;
  #restartedAt = Number.NEGATIVE_INFINITY;

  /** `track`: the own voice; null: sends nothing. */
  constructor(options: VoicePeerOptions, track: MediaStreamTrack | null) {
    this.#options = options;
    this.#track = track;
    this.#pc = new RTCPeerConnection(options.configuration);
    this.#pc.addEventListener('negotiationneeded', () => void this.#offer());
    this.#pc.addEventListener('icecandidate', ({ candidate }) => candidate && this.#gather(candidate));
    this.#pc.addEventListener('track', ({ track: theirs }) => {
      if (!this.#closed) options.onStream(new MediaStream([theirs]));
    });
    if (options.polite) return;
    const transceiver = this.#pc.addTransceiver('audio', { direction: 'sendrecv' });
    opusAlone(transceiver);
    void transceiver.sender.replaceTrack(track);
  }

  get state(): RTCPeerConnectionState {
    return this.#pc.connectionState;
  }

  /** Replaces the own voice; null: sends nothing. */
  setTrack(track: MediaStreamTrack | null): void {
    this.#track = track;
    for (const { sender } of this.#pc.getTransceivers()) void sender.replaceTrack(track);
  }

  async receive(body: SignalBody): Promise<void> {
    try {
      if ('description' in body) await this.#takeDescription(body.description);
      else for (const candidate of body.candidates) await this.#takeCandidate(candidate);
    } catch (error) {
      // An unexpected answer, or a connection that was closed meanwhile: the next ICE restart recovers.
      if (!(error instanceof DOMException)) throw error;
    }
  }

  /** Restarts a lost connection at this time [s]. `reachable`: whether the room receives signals. */
  restartIfLost(now: number, reachable: boolean): void {
    if (!reachable) return;
    const { signalingState, connectionState } = this.#pc;
    if (signalingState === 'have-local-offer') {
      if (now - this.#offeredAt < answerSeconds) return;
      this.#offeredAt = now;
      this.#sendDescription();
      return;
    }
    const lost = connectionState === 'disconnected' || connectionState === 'failed';
    if (!lost || now - this.#restartedAt < restartSeconds) return;
    this.#restartedAt = now;
    this.#pc.restartIce();
  }

  /** Applies other ICE servers. New candidates are gathered, and the voices continue meanwhile. */
  configure(configuration: RTCConfiguration): void {
    this.#pc.setConfiguration(configuration);
    this.#pc.restartIce();
  }

  /** Closes the connection; nothing more is sent or received. */
  close(): void {
    if (this.#closed) return;
    this.#closed = true;
    if (this.#gathering !== null) clearTimeout(this.#gathering);
    this.setTrack(null);
    setTimeout(() => this.#pc.close(), closingMs);
  }

  async #offer(): Promise<void> {
    try {
      this.#offering = true;
      await this.#pc.setLocalDescription();
      this.#offeredAt = performance.now() / 1000;
      this.#sendDescription();
    } catch (error) {
      // The connection was closed meanwhile.
      if (!(error instanceof DOMException)) throw error;
    } finally {
      this.#offering = false;
    }
  }

  #sendDescription(): void {
    const description = this.#pc.localDescription;
    if (this.#closed || !description || (description.type !== 'offer' && description.type !== 'answer')) return;
    this.#options.signal({ description: { type: description.type, sdp: shortened(description.sdp) } });
  }

  async #takeDescription(description: { readonly type: 'offer' | 'answer'; readonly sdp: string }): Promise<void> {
    const pc = this.#pc;
    const free = !this.#offering && (pc.signalingState === 'stable' || this.#answering);
    const collides = description.type === 'offer' && !free;
    this.#ignoring = collides && !this.#options.polite;
    // A repeated offer has two answers; the second is late.
    const late = description.type === 'answer' && pc.signalingState !== 'have-local-offer';
    if (this.#ignoring || late) return;
    this.#answering = description.type === 'answer';
    await pc.setRemoteDescription(description).finally(() => {
      this.#answering = false;
    });
    if (description.type !== 'offer') return;
    for (const transceiver of pc.getTransceivers()) {
      transceiver.direction = 'sendrecv';
      void transceiver.sender.replaceTrack(this.#track);
    }
    await pc.setLocalDescription();
    this.#sendDescription();
  }

  async #takeCandidate(candidate: Candidate): Promise<void> {
    try {
      await this.#pc.addIceCandidate(candidate);
    } catch (error) {
      // Candidates of an ignored offer, or from before a restart, have no description.
      if (!(error instanceof DOMException)) throw error;
    }
  }

  #gather({ candidate, sdpMid, sdpMLineIndex, usernameFragment }: RTCIceCandidate): void {
    if (this.#closed || candidate.length > longestCandidate || !isPassableCandidate(candidate)) return;
    this.#candidates.push({ candidate, sdpMid, sdpMLineIndex, usernameFragment });
    this.#gathering ??= setTimeout(() => {
      this.#gathering = null;
      while (this.#candidates.length > 0) {
        this.#options.signal({ candidates: this.#candidates.splice(0, maxCandidates) });
      }
    }, gatherMs);
  }
}
