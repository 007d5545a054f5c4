import type { ClientMessage } from '../protocol/messages';
import { maxVoiceSeats, type Voice } from '../protocol/voice-messages';
import type { HostedGame } from './match-policy';
import type { RefusalReason, RoomHost } from './room-host';
import type { Member, Seats } from './seats';

type Received<Type extends ClientMessage['type']> = Extract<ClientMessage, { type: Type }>;

/**
 * The voice sessions of a room, and the signals by which their pages connect. Sound never passes through the room:
 * pages send it to each other. A spectator has no seat, and therefore no voice.
 */
export class RoomVoices {
  readonly #seats: Seats;
  readonly #enabled: boolean;
  readonly #host: Pick<RoomHost<HostedGame>, 'send'>;

  /** `wanted`: the room's host allows voices; a room with more than `maxVoiceSeats` seats has none even then. */
  constructor(seats: Seats, wanted: boolean, host: Pick<RoomHost<HostedGame>, 'send'>) {
    this.#seats = seats;
    this.#enabled = wanted && seats.count <= maxVoiceSeats;
    this.#host = host;
  }

  /**
   * Returns the voice with which a joining person takes part; null where the room has no voices or the session is
   * taken.
   */
  admitted(identity: string, voice: Voice | null): Voice | null {
    if (!voice || !this.#enabled) return null;
    const taken = this.#seats.withVoice(voice.session);
    // A page that reconnects finds its own session on the held seat.
    return taken !== null && this.#seats.at(taken)?.identity !== identity ? null : voice;
  }

  /** Applies a message of a member on this seat (null: a spectator). Returns why it is refused, or null. */
  onMessage(index: number | null, member: Member, message: Received<'voice' | 'signal'>): RefusalReason | null {
    return message.type === 'signal' ? this.#pass(index, message) : this.#change(index, member, message.voice);
  }

  /** Adds the member to the voices, or removes it (null). */
  #change(index: number | null, member: Member, voice: Voice | null): RefusalReason | null {
    if (!this.#enabled) return 'no-voices';
    if (index === null && voice) return 'no-seat';
    const taken = voice && this.#seats.withVoice(voice.session);
    if (taken !== null && taken !== index) return 'session-taken';
    member.voice = voice;
    if (index !== null) this.#seats.update(index, { voice });
    return null;
  }

  /** Forwards a signal to the page that it names, with the sender's own session. */
  #pass(index: number | null, { to, body }: Received<'signal'>): RefusalReason | null {
    if (!this.#enabled) return 'no-voices';
    const sender = index === null ? null : this.#seats.at(index);
    if (!sender) return 'no-seat';
    const receiver = this.#seats.withVoice(to);
    const client = receiver === null || receiver === index ? null : (this.#seats.at(receiver)?.client ?? null);
    if (!sender.voice || client === null) return 'no-receiver';
    this.#host.send(client, { type: 'signal', from: sender.voice.session, body });
    return null;
  }
}
