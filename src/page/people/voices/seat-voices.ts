import type { RemotePerson } from 'threepoint/core';
import { smoothstep, transformPoint, vec3 } from 'threepoint/math';
import type { HostedGame, RoomView } from 'threepoint-rooms/room';
import type { BlockList } from './block-list';
import type { VoiceCall } from './voice-call';
import type { PersonVoice } from './voices-state';

/** A mouth is closed up to the first level (breath, the noise of a room), and open at the second. */
const mouthClosedAt = 0.35;
const mouthOpenAt = 0.95;

/** The voices of a room by the seats of their players: level, position, and what the user has blocked. */
export class SeatVoices {
  readonly #blocked: Pick<BlockList, 'has' | 'mutes'>;
  readonly #room: () => RoomView<HostedGame> | null;
  /** The session of the player on each seat; null: the player takes no part in the voices. */
  readonly #sessions: (string | null)[] = [];
  readonly #levels: number[] = [];
  readonly #head = vec3(0, 0, 0);
  #mySeat: number | null = null;
  #call: VoiceCall | null = null;

  constructor(blocked: Pick<BlockList, 'has' | 'mutes'>, room: () => RoomView<HostedGame> | null) {
    this.#blocked = blocked;
    this.#room = room;
  }

  /** Joins or leaves (null) the voices. */
  setCall(call: VoiceCall | null): void {
    this.#call = call;
    if (call) this.update();
  }

  /** The players in the room or their voices have changed. */
  update(): void {
    const room = this.#room();
    const seats = room?.seats ?? [];
    const mine = room?.mySeat ?? null;
    for (let seat = 0; seat < seats.length; seat++) {
      this.#sessions[seat] = seat === mine ? null : (seats[seat]?.voice?.session ?? null);
    }
    this.applyBlocks();
    const moved = mine !== this.#mySeat;
    this.#mySeat = mine;
    this.#call?.connect(this.#sessions, mine !== null, moved);
  }

  /** Silences the voices of blocked players. */
  applyBlocks(): void {
    for (let seat = 0; seat < this.#sessions.length; seat++) {
      const session = this.#sessions[seat];
      if (session) this.#call?.sound.setSilent(session, this.#blocked.mutes(seat));
    }
  }

  /** Once per frame: reads levels, and places each voice at the head of its body. */
  locate(bodies: readonly RemotePerson[]): void {
    this.#readLevels();
    if (!this.#call) return;
    for (let i = 0; i < bodies.length; i++) {
      const { id, placement, pose } = bodies[i]!;
      const session = this.#sessions[id];
      if (session) this.#call.sound.place(session, transformPoint(placement, pose.head.position, this.#head));
    }
  }

  /** The voice of the player on a seat, for lists. */
  voiceOf(seat: number): PersonVoice {
    const voice = this.#room()?.seats[seat]?.voice ?? null;
    const session = this.#sessions[seat];
    const state = session ? (this.#call?.mesh.stateOf(session) ?? null) : null;
    return {
      voice: voice === null ? 'none' : voice.muted ? 'muted' : 'open',
      link: state === null ? 'none' : linkOf(state),
      silenced: this.#blocked.has('silenced', seat),
      hidden: this.#blocked.has('hidden', seat),
    };
  }

  /** The voice mark on the label of a player: whether they take part, and are audible here. */
  markOf(seat: number): 'none' | 'muted' | 'open' {
    const voice = this.#room()?.seats[seat]?.voice;
    if (!voice) return 'none';
    return voice.muted || this.#blocked.mutes(seat) ? 'muted' : 'open';
  }

  /** The level of a player's voice in the newest frame, from 0 to 1. The user's own is as other pages receive it. */
  levelOf(seat: number): number {
    return this.#levels[seat] ?? 0;
  }

  /** How far a player's mouth is open, from 0 to 1. */
  mouthOf(seat: number): number {
    return smoothstep(mouthClosedAt, mouthOpenAt, this.levelOf(seat));
  }

  /** How far the user's mouth is open, from 0 to 1. */
  get ownMouth(): number {
    return this.#mySeat === null ? 0 : this.mouthOf(this.#mySeat);
  }

  /** Returns what tools may know of the levels, from 0 to 1. */
  probe() {
    const room = this.#room();
    return {
      ownLevel: this.#mySeat === null ? 0 : this.levelOf(this.#mySeat),
      people: (room?.seats ?? []).flatMap((info, seat) =>
        info && seat !== room?.mySeat ? [{ seat, level: this.levelOf(seat), ...this.voiceOf(seat) }] : [],
      ),
    };
  }

  #readLevels(): void {
    const call = this.#call;
    this.#levels.length = this.#sessions.length;
    for (let seat = 0; seat < this.#levels.length; seat++) {
      const session = this.#sessions[seat];
      let level = 0;
      if (call && seat === this.#mySeat) level = call.sound.ownLevel();
      else if (call && session && this.markOf(seat) === 'open') level = call.sound.level(session);
      this.#levels[seat] = level;
    }
  }
}

function linkOf(state: RTCPeerConnectionState): PersonVoice['link'] {
  if (state === 'connected') return 'connected';
  return state === 'new' || state === 'connecting' ? 'connecting' : 'lost';
}
