import { firstLine, reasonOf } from 'threepoint/core';
import type { RoomClient } from 'threepoint-rooms';
import type { VoiceChannel } from 'threepoint-rooms/internal';
import { hasRelay, IceServerCache, Microphone, type VoiceSettings } from 'threepoint-rooms/internal';
import type { HostedGame } from 'threepoint-rooms/room';
import type { BlockList } from './block-list';
import { SeatVoices } from './seat-voices';
import { VoiceCall } from './voice-call';
import type { VoicesState } from './voices-state';

export interface VoicesOptions {
  readonly client: Pick<RoomClient<HostedGame>, 'room' | 'status' | 'connection'>;
  readonly blocked: Pick<BlockList, 'has' | 'mutes'>;
  /** Requests the server's terms of voices; null: the room is in this page, or belongs to a study. */
  readonly terms: (() => Promise<VoiceSettings>) | null;
  /** Opens the audio that the game's own sounds play in. */
  openAudio(): Promise<AudioContext>;
  /** Voices are sent through the TURN relay only, so that no page learns this one's address. */
  relayOnly(): boolean;
}

const spectatorText = 'You are watching. Only players on the seats can talk.';

/** The interval between two repairs of the connections [ms], whether or not the page is visible. */
const watchMs = 500;

/** The user's part in the voices of a room: joining, leaving and the microphone. */
export class Voices {
  readonly seats: SeatVoices;
  readonly #options: VoicesOptions;
  readonly #microphone = new Microphone(() => {
    this.#sendTrack();
    if (this.#silent !== this.#announcedSilent) this.#announce();
  });
  readonly #terms: IceServerCache | null;
  #channel: VoiceChannel | null = null;
  #requested = false;
  #phase: 'off' | 'asked' | 'joining' | 'in' = 'off';
  #muted = true;
  /** The value of `#silent` that other pages know. */
  #announcedSilent = true;
  #fault: string | null = null;
  #call: VoiceCall | null = null;
  #watching: ReturnType<typeof setInterval> | undefined;
  /** Changes with every leaving, which cancels what was started before. */
  #turn = 0;
  #disposed = false;

  constructor(options: VoicesOptions) {
    this.#options = options;
    this.#terms = options.terms && new IceServerCache(options.terms);
    this.seats = new SeatVoices(options.blocked, () => options.client.room);
  }

  get state(): VoicesState {
    const { client, relayOnly } = this.#options;
    const terms = this.#terms?.newest ?? null;
    const offered = terms?.voices === true && client.room !== null && client.status.phase !== 'ended';
    const relay = terms !== null && hasRelay(terms);
    return {
      phase: offered ? this.#phase : 'none',
      muted: this.#silent,
      relay,
      relayOnly: relay && relayOnly(),
      message: this.#message,
      microphoneMissing: this.#phase === 'in' && this.#microphone.errorMessage !== null,
    };
  }

  /** Once per frame, after the room's messages were received. */
  begin(): void {
    const { client } = this.#options;
    const channel = client.connection?.voices ?? null;
    if (channel !== this.#channel) {
      this.#channel = channel;
      this.#channel?.setListener({
        onSeatsChanged: () => this.seats.update(),
        onSignal: (from, body) => this.#call?.mesh.receive(from, body),
      });
      this.seats.update();
    }
    if (!this.#requested && this.#terms && client.room) {
      this.#requested = true;
      // reason: a server that does not answer has no voices
      void this.#terms.refresh().catch(() => undefined);
    }
    if ((this.#call || this.#phase === 'joining') && client.status.phase === 'ended') this.leave();
  }

  /** Shows or hides the consent text. A spectator learns instead that only players talk. */
  ask(on: boolean): void {
    this.#fault = null;
    if (on && this.#isSpectator) {
      this.#fault = spectatorText;
      return;
    }
    if (this.#phase === 'off' && on) this.#phase = 'asked';
    else if (this.#phase === 'asked' && !on) this.#phase = 'off';
  }

  /** Joins the voices, muted. Call it within a gesture of the user. Never rejects. */
  async join(): Promise<void> {
    const { openAudio } = this.#options;
    const terms = this.#terms;
    if (!terms || this.#disposed || this.#call || this.#phase === 'joining') return;
    if (this.#isSpectator) {
      this.#phase = 'off';
      this.#fault = spectatorText;
      return;
    }
    const turn = this.#turn;
    this.#phase = 'joining';
    this.#fault = null;
    this.#muted = true;
    try {
      const [context, fresh] = await Promise.all([openAudio(), terms.refresh()]);
      if (turn !== this.#turn) return;
      await this.#microphone.open();
      if (turn === this.#turn) this.#enter(context, fresh);
    } catch (error) {
      if (turn !== this.#turn) return;
      this.#microphone.close();
      this.#phase = 'off';
      this.#fault = `Voice chat could not be joined: ${firstLine(reasonOf(error))}`;
    }
  }

  leave(): void {
    this.#turn += 1;
    this.#phase = 'off';
    this.#muted = true;
    this.#channel?.setVoice(null);
    this.#microphone.close();
    clearInterval(this.#watching);
    this.seats.setCall(null);
    this.#call?.dispose();
    this.#call = null;
  }

  /** Mutes or unmutes the user. If there is no microphone, requests it first. */
  async setMuted(muted: boolean): Promise<void> {
    if (this.#phase !== 'in') return;
    const turn = this.#turn;
    if (!muted && !this.#microphone.track) await this.#microphone.open();
    if (turn !== this.#turn) return;
    this.#muted = muted || !this.#microphone.track;
    this.#sendTrack();
    this.#announce();
  }

  toggleMuted(): void {
    void this.setMuted(!this.#silent);
  }

  /**
   * Returns what tools may know of the voices. `loudness`: all of them at the own ears [dB of full scale], −120:
   * silence; `spokenLoudness`: before distance and direction change them.
   */
  probe() {
    const { phase, muted, message } = this.state;
    const loudness = this.#call?.loudness() ?? { loudness: -120, spokenLoudness: -120 };
    return { phase, muted, message, ...loudness, ...this.seats.probe() };
  }

  dispose(): void {
    this.#disposed = true;
    this.#channel?.setListener(null);
    this.leave();
  }

  get #isSpectator(): boolean {
    return this.#options.client.room?.mySeat === null;
  }

  /** The user is muted or has no microphone. */
  get #silent(): boolean {
    return this.#muted || this.#microphone.track === null;
  }

  get #message(): string | null {
    if (this.#phase !== 'in') return this.#fault === spectatorText && !this.#isSpectator ? null : this.#fault;
    if (this.#isSpectator) return spectatorText;
    const { errorMessage } = this.#microphone;
    return errorMessage && `${errorMessage} You can still hear the others.`;
  }

  #configurationOf({ iceServers }: VoiceSettings): RTCConfiguration {
    return { iceServers: [...iceServers], iceTransportPolicy: this.state.relayOnly ? 'relay' : 'all' };
  }

  #enter(context: AudioContext, terms: VoiceSettings): void {
    this.#call = new VoiceCall({
      context,
      configuration: this.#configurationOf(terms),
      signal: (to, body) => this.#channel?.sendSignal(to, body),
      onSession: () => this.#announce(),
      onVoice: () => this.seats.applyBlocks(),
    });
    this.#watching = setInterval(() => this.#watch(), watchMs);
    this.#phase = 'in';
    this.#announce();
    this.#sendTrack();
    this.seats.setCall(this.#call);
  }

  #announce(): void {
    this.#announcedSilent = this.#silent;
    if (this.#call) this.#channel?.setVoice({ session: this.#call.session, muted: this.#announcedSilent });
  }

  /**
   * Sends the microphone unless it is muted. It stays open, so that unmuting in a headset shows no permission prompt.
   */
  #sendTrack(): void {
    const { track } = this.#microphone;
    if (!this.#call) return;
    if (track) track.enabled = !this.#muted;
    this.#call.setTrack(this.#muted ? null : track);
  }

  #watch(): void {
    this.#call?.watch(this.#options.client.status.phase === 'joined');
    void this.#terms
      ?.refreshIfDue()
      .then((renewed) => renewed && this.#call?.mesh.configure(this.#configurationOf(renewed)));
  }
}

export type VoicesProbe = ReturnType<Voices['probe']>;
