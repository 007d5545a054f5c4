import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import { smoothstep } from 'threepoint/core/math/damper';
import { transformPoint } from 'threepoint/core/math/pose';
import { vec3 } from 'threepoint/core/math/vec3';
import type { VoiceChannel } from 'threepoint-rooms/client/connection';
import type { SignalBody } from 'threepoint-rooms/protocol/voice-messages';
import { IceServerCache } from 'threepoint-rooms/voices/ice-server-cache';
import { Microphone } from 'threepoint-rooms/voices/microphone';
import { VoiceMesh } from 'threepoint-rooms/voices/voice-mesh';
import { hasRelay, type VoiceSettings } from 'threepoint-rooms/voices/voice-settings';
import { VoiceSound } from '../scene/sound/voice-sound';
import type { BodyFrame } from './ball-frame';
import type { BallPlay } from './ball-play';
import { PersonMarks } from './person-marks';
import type { PersonVoice, VoicesProbe, VoicesState } from './voices-state';

export interface VoicesOptions {
  readonly play: Pick<BallPlay, 'room' | 'status' | 'voices'>;
  /** What the room's server says of voices; null: the room is in this page, or a study's. */
  readonly terms: (() => Promise<VoiceSettings>) | null;
  /** The audio that the game's own sounds play in. */
  openAudio(): Promise<AudioContext>;
  /** Voices go by a relay alone, so that no page learns this one's address. */
  relayOnly(): boolean;
}

/** Connections are looked after this often [ms], seen or hidden. */
const watchMs = 500;

/** A mouth stays shut up to the first of these levels (breath, a room's noise), and is open at the second. */
const mouthShutAt = 0.35;
const mouthOpenAt = 0.95;

const newSession = (): string => {
  const bytes = crypto.getRandomValues(new Uint8Array(8));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, '0')).join('');
};

/** The own page among the voices: what is needed only there, from joining to leaving. */
interface Stay {
  /** Another one wherever the connections begin anew: both pages of each have to. */
  session: string;
  readonly mesh: VoiceMesh;
  /** Sessions that this page has a connection to, and those that it has closed one to. */
  readonly linked: Set<string>;
  readonly dropped: Set<string>;
  readonly sound: VoiceSound;
  readonly context: AudioContext;
  readonly watching: ReturnType<typeof setInterval>;
}

/** The voices of a room of the ball game: who talks, from where, and what the user wants of it. */
export class Voices {
  readonly #options: VoicesOptions;
  readonly #microphone = new Microphone(() => {
    this.#sendTrack();
    if (this.#silent !== this.#toldSilent) this.#say();
  });
  readonly #marks = new PersonMarks();
  /** By seat: the session of a page that takes part; null: none does. */
  readonly #sessions: (string | null)[] = [];
  readonly #mouth = vec3(0, 0, 0);
  readonly #seen: BodyFrame[] = [];
  /** How loud each seat's player speaks in this frame. */
  readonly #levels: number[] = [];
  #line: VoiceChannel | null = null;
  #mySeat: number | null = null;
  readonly #terms: IceServerCache | null;
  #asked = false;
  #phase: 'off' | 'asked' | 'joining' | 'in' = 'off';
  #muted = true;
  /** What the others know of `#silent`. */
  #toldSilent = true;
  #fault: string | null = null;
  #stay: Stay | null = null;
  /** Another one with every leaving: what was begun before it is not gone on with. */
  #turn = 0;
  #disposed = false;

  constructor(options: VoicesOptions) {
    this.#options = options;
    this.#terms = options.terms && new IceServerCache(options.terms);
  }

  get state(): VoicesState {
    const { play, relayOnly } = this.#options;
    const terms = this.#terms?.newest ?? null;
    const there = terms?.voices === true && play.room !== null && play.status.phase !== 'ended';
    const relay = terms !== null && hasRelay(terms);
    return {
      phase: there ? this.#phase : 'none',
      muted: this.#silent,
      relay,
      relayOnly: relay && relayOnly(),
      said: this.#said,
      deaf: this.#phase === 'in' && this.#microphone.errorMessage !== null,
    };
  }

  /** Seats whose players are not to be seen here. */
  get hidden(): ReadonlySet<number> {
    return this.#marks.hidden;
  }

  /** Once a frame, when the room has been heard. */
  begin(): void {
    const { play } = this.#options;
    if (play.voices !== this.#line) {
      this.#line = play.voices;
      this.#line?.listen({
        onSeatsChanged: () => this.#follow(),
        onSignal: (from, body) => this.#hear(from, body),
      });
      this.#follow();
    }
    if (!this.#asked && this.#terms && play.room) {
      this.#asked = true;
      // A server that does not say has no voices.
      void this.#terms.refresh().catch(() => undefined);
    }
    if ((this.#stay || this.#phase === 'joining') && play.status.phase === 'ended') this.leave();
  }

  /** Once a frame: lets voices come from where these bodies have their heads. Gives those that are to be seen, until the next call. */
  show(bodies: readonly BodyFrame[]): readonly BodyFrame[] {
    this.#seen.length = 0;
    this.#readLevels();
    for (let i = 0; i < bodies.length; i++) {
      const body = bodies[i]!;
      const session = this.#sessions[body.id];
      if (session && this.#stay)
        this.#stay.sound.place(session, transformPoint(body.placement, body.pose.head.position, this.#mouth));
      if (!this.hidden.has(body.id)) this.#seen.push(body);
    }
    return this.#seen;
  }

  /** The user wants to know what voices mean, or no longer. */
  ask(on: boolean): void {
    if (this.#phase === 'off' && on) this.#phase = 'asked';
    else if (this.#phase === 'asked' && !on) this.#phase = 'off';
  }

  /** Takes part, muted. Within a gesture of the user; never rejects. */
  async join(): Promise<void> {
    const { openAudio } = this.#options;
    const terms = this.#terms;
    if (!terms || this.#disposed || this.#stay || this.#phase === 'joining') return;
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
      this.#fault = `Voices could not be joined: ${firstLine(reasonOf(error))}`;
    }
  }

  leave(): void {
    this.#turn += 1;
    const stay = this.#stay;
    this.#stay = null;
    this.#phase = 'off';
    this.#muted = true;
    this.#line?.setVoice(null);
    this.#microphone.close();
    if (!stay) return;
    clearInterval(stay.watching);
    stay.mesh.close();
    stay.sound.dispose();
  }

  /** Unmuted without a microphone, it is asked for again first. */
  async setMuted(muted: boolean): Promise<void> {
    if (this.#phase !== 'in') return;
    const turn = this.#turn;
    if (!muted && !this.#microphone.track) await this.#microphone.open();
    if (turn !== this.#turn) return;
    this.#muted = muted || !this.#microphone.track;
    this.#sendTrack();
    this.#say();
  }

  toggleMuted(): void {
    void this.setMuted(!this.#silent);
  }

  /** Does not hear the player on this seat any more, or does again. */
  silence(seat: number, on: boolean): void {
    this.#marks.set('silenced', seat, on);
    this.#applySilence(seat);
  }

  /** Neither sees nor hears the player on this seat any more, or does again. */
  hide(seat: number, on: boolean): void {
    this.#marks.set('hidden', seat, on);
    this.#applySilence(seat);
  }

  voiceOf(seat: number): PersonVoice {
    const voice = this.#options.play.room?.seats[seat]?.voice ?? null;
    const session = this.#sessions[seat];
    const state = session ? (this.#stay?.mesh.stateOf(session) ?? null) : null;
    return {
      voice: voice === null ? 'none' : voice.muted ? 'muted' : 'open',
      link: state === null ? 'none' : linkOf(state),
      silenced: this.#marks.has('silenced', seat),
      hidden: this.#marks.has('hidden', seat),
    };
  }

  /** What the label of a player shows: whether they take part, and could be heard here. */
  markOf(seat: number): 'none' | 'muted' | 'open' {
    const voice = this.#options.play.room?.seats[seat]?.voice;
    if (!voice) return 'none';
    return voice.muted || this.#marks.mutes(seat) ? 'muted' : 'open';
  }

  /** How loud a player speaks, as the newest frame has it: 0 to 1; own: the own voice, as others hear it. */
  levelOf(seat: number): number {
    return this.#levels[seat] ?? 0;
  }

  /** How far a player's mouth is open as they speak: 0 shut to 1. */
  mouthOf(seat: number): number {
    return smoothstep(mouthShutAt, mouthOpenAt, this.levelOf(seat));
  }

  /** The same of the player on the own seat. */
  get ownMouth(): number {
    return this.#mySeat === null ? 0 : this.mouthOf(this.#mySeat);
  }

  probe(): VoicesProbe {
    const seats = this.#options.play.room?.seats ?? [];
    const { phase, muted, said } = this.state;
    return {
      phase,
      muted,
      said,
      loudness: this.#stay?.sound.loudness() ?? -120,
      spokenLoudness: this.#stay?.sound.spokenLoudness() ?? -120,
      ownLevel: this.#mySeat === null ? 0 : this.levelOf(this.#mySeat),
      people: seats.flatMap((info, seat) =>
        info && seat !== this.#options.play.room?.mySeat
          ? [{ seat, level: this.levelOf(seat), ...this.voiceOf(seat) }]
          : [],
      ),
    };
  }

  dispose(): void {
    this.#disposed = true;
    this.#line?.listen(null);
    this.leave();
  }

  /** Nothing of the own voice is sent: by the user's wish, or for want of a microphone. */
  get #silent(): boolean {
    return this.#muted || this.#microphone.track === null;
  }

  get #said(): string | null {
    if (this.#phase !== 'in') return this.#fault;
    if (this.#options.play.room?.mySeat === null) return 'You are watching: voices are for the players on the seats.';
    const { errorMessage } = this.#microphone;
    return errorMessage && `${errorMessage} You hear the others all the same.`;
  }

  #configurationOf({ iceServers }: VoiceSettings): RTCConfiguration {
    return { iceServers: [...iceServers], iceTransportPolicy: this.state.relayOnly ? 'relay' : 'all' };
  }

  #enter(context: AudioContext, terms: VoiceSettings): void {
    const sound = new VoiceSound(context);
    const mesh = new VoiceMesh({
      configuration: this.#configurationOf(terms),
      signal: (to, body) => this.#line?.signal(to, body),
      onStream: (session, stream) => this.#play(session, stream),
    });
    const watching = setInterval(() => this.#watch(), watchMs);
    const sessions = { session: newSession(), linked: new Set<string>(), dropped: new Set<string>() };
    this.#stay = { ...sessions, mesh, sound, context, watching };
    this.#phase = 'in';
    this.#say();
    this.#sendTrack();
    this.#follow();
  }

  #say(): void {
    this.#toldSilent = this.#silent;
    if (this.#stay) this.#line?.setVoice({ session: this.#stay.session, muted: this.#toldSilent });
  }

  /** A muted microphone stays open, so that no question comes up in a headset; nothing of it is sent. */
  #sendTrack(): void {
    const { track } = this.#microphone;
    if (!this.#stay) return;
    if (track) track.enabled = !this.#muted;
    this.#stay.mesh.setTrack(this.#muted ? null : track);
    this.#stay.sound.setOwn(this.#muted ? null : track);
  }

  #hear(from: string, body: SignalBody): void {
    this.#stay?.mesh.receive(from, body);
  }

  /** Connects to those who take part now. */
  #follow(): void {
    const room = this.#options.play.room;
    const seats = room?.seats ?? [];
    const mine = room?.mySeat ?? null;
    this.#marks.follow(seats);
    for (let seat = 0; seat < seats.length; seat++) {
      this.#sessions[seat] = seat === mine ? null : (seats[seat]?.voice?.session ?? null);
      this.#applySilence(seat);
    }
    const moved = mine !== this.#mySeat;
    this.#mySeat = mine;
    if (this.#stay) this.#connect(this.#stay, mine !== null, moved);
  }

  /** `seated`: on a seat; `moved`: on another one than before. */
  #connect(stay: Stay, seated: boolean, moved: boolean): void {
    const others = seated ? this.#sessions.filter((session) => session !== null) : [];
    // Their page may have kept its half of a connection whose other half was closed here: under a new session it closes it too.
    if (seated && (moved || others.some((session) => stay.dropped.has(session)))) {
      stay.mesh.close();
      stay.linked.clear();
      stay.dropped.clear();
      stay.session = newSession();
      this.#say();
    }
    for (const session of stay.linked) if (!others.includes(session)) stay.dropped.add(session);
    stay.linked.clear();
    for (const session of others) stay.linked.add(session);
    stay.mesh.follow(seated ? stay.session : null, others);
  }

  #play(session: string, stream: MediaStream | null): void {
    if (!stream) {
      this.#stay?.sound.remove(session);
      return;
    }
    this.#stay?.sound.add(session, stream);
    const seat = this.#sessions.indexOf(session);
    if (seat >= 0) this.#applySilence(seat);
  }

  #applySilence(seat: number): void {
    const session = this.#sessions[seat];
    if (session) this.#stay?.sound.setSilent(session, this.#marks.mutes(seat));
  }

  #readLevels(): void {
    const stay = this.#stay;
    this.#levels.length = this.#sessions.length;
    for (let seat = 0; seat < this.#levels.length; seat++) {
      const session = this.#sessions[seat];
      let level = 0;
      if (stay && seat === this.#mySeat) level = stay.sound.ownLevel();
      else if (stay && session && this.markOf(seat) === 'open') level = stay.sound.level(session);
      this.#levels[seat] = level;
    }
  }

  #watch(): void {
    const { stay, play } = { stay: this.#stay, play: this.#options.play };
    if (!stay) return;
    stay.mesh.watch(performance.now() / 1000, play.status.phase === 'joined');
    // A headset's sleep stops the audio too.
    if (stay.context.state === 'suspended' && document.visibilityState === 'visible') void stay.context.resume();
    stay.sound.mend();
    void this.#terms
      ?.refreshIfDue()
      .then((renewed) => renewed && this.#stay?.mesh.configure(this.#configurationOf(renewed)));
  }
}

function linkOf(state: RTCPeerConnectionState): PersonVoice['link'] {
  if (state === 'connected') return 'connected';
  return state === 'new' || state === 'connecting' ? 'connecting' : 'lost';
}
