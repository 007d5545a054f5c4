import { longestDescription, mostCandidates, type SignalBody } from '../protocol/voice-messages';

export interface VoicePeerOptions {
  /** Gives way where both pages want to change their connection at once; the other one makes the first offer. */
  readonly polite: boolean;
  readonly configuration: RTCConfiguration;
  signal(body: SignalBody): void;
  /** The voice of the other, for as long as the connection lasts. */
  onStream(stream: MediaStream): void;
}

type Candidate = Extract<SignalBody, { candidates: unknown }>['candidates'][number];

/** Addresses are found within moments of each other: those of such a moment [ms] go together. */
const gatherMs = 60;
/** An offer that no one has answered is made again after so long [s]. */
const answerSeconds = 2;
/** A connection that is lost is looked for again this often [s], where the room can be reached. */
const restartSeconds = 2.5;
const longestCandidate = 300;
/**
 * A connection is closed this long after it is over [ms]. Chromium keeps one for good that is closed in the moment after an answer: of 100
 * that came and went at random 9 to 14, and one at most with this wait (tried with Chromium 156).
 */
const closingMs = 250;

/** Without the addresses in it, where it is too long for a message with them: they are sent by themselves too. */
const shortened = (sdp: string): string =>
  sdp.length <= longestDescription ? sdp : sdp.replace(/^a=(candidate|end-of-candidates).*\r\n/gm, '');

/** The one codec that all browsers have for voices: an offer with the others is three times as long. */
function opusAlone(transceiver: RTCRtpTransceiver): void {
  const codecs = RTCRtpReceiver.getCapabilities('audio')?.codecs ?? [];
  const opus = codecs.filter(({ mimeType }) => mimeType.toLowerCase() === 'audio/opus');
  // Older browsers have no choice of codecs.
  if (opus.length > 0) transceiver.setCodecPreferences?.(opus);
}

/**
 * A connection to the page of one other person, which carries both voices. Set up and changed by perfect negotiation (WebRTC 1.0, section
 * 10.7): either page may begin, and where both do, the polite one takes its own beginning back.
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

  /** `track`: the own voice; null: nothing is sent. */
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

  /** The own voice from now on; null: nothing is sent. */
  setTrack(track: MediaStreamTrack | null): void {
    this.#track = track;
    for (const { sender } of this.#pc.getTransceivers()) void sender.replaceTrack(track);
  }

  /** Takes in what the other page has signalled. */
  async receive(body: SignalBody): Promise<void> {
    try {
      if ('description' in body) await this.#takeDescription(body.description);
      else for (const candidate of body.candidates) await this.#takeCandidate(candidate);
    } catch (error) {
      // A page that answers what was not asked, or a connection that was closed meanwhile: the next restart begins anew.
      if (!(error instanceof DOMException)) throw error;
    }
  }

  /** Looks after the connection, at this time [s]; `reachable`: signals arrive at the room. */
  watch(now: number, reachable: boolean): void {
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

  /** By these servers from now on: addresses are found anew, and the voices go by the old ones until then. */
  configure(configuration: RTCConfiguration): void {
    this.#pc.setConfiguration(configuration);
    this.#pc.restartIce();
  }

  /** Nothing is sent, signalled or heard from now on. */
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
      // Closed while it was being described.
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
    // An offer made twice is answered twice.
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
      // Addresses of an offer that was ignored, or of one from before a restart, belong to nothing.
      if (!(error instanceof DOMException)) throw error;
    }
  }

  #gather({ candidate, sdpMid, sdpMLineIndex, usernameFragment }: RTCIceCandidate): void {
    if (this.#closed || candidate.length > longestCandidate) return;
    this.#candidates.push({ candidate, sdpMid, sdpMLineIndex, usernameFragment });
    this.#gathering ??= setTimeout(() => {
      this.#gathering = null;
      while (this.#candidates.length > 0) {
        this.#options.signal({ candidates: this.#candidates.splice(0, mostCandidates) });
      }
    }, gatherMs);
  }
}
