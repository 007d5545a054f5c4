import type { ClientMessage } from '../protocol/messages';
import { mostVoices, type Voice } from '../protocol/voice-messages';
import type { HostedGame } from './match-policy';
import type { RefusalReason, RoomHost } from './room-host';
import type { Member, Seats } from './seats';

type Received<Type extends ClientMessage['type']> = Extract<ClientMessage, { type: Type }>;

/**
 * Who takes part in the voices of a room, and what their pages tell each other to connect. No sound comes by here: pages send it to each other. Who
 * watches has no seat, and so neither speaks nor hears.
 */
export class RoomVoices {
  readonly #seats: Seats;
  readonly #enabled: boolean;
  readonly #host: Pick<RoomHost<HostedGame>, 'send'>;

  /** `wanted`: by the room's host; a room with too many seats for it has no voices all the same. */
  constructor(seats: Seats, wanted: boolean, host: Pick<RoomHost<HostedGame>, 'send'>) {
    this.#seats = seats;
    this.#enabled = wanted && seats.count <= mostVoices;
    this.#host = host;
  }

  /** How a person who joins takes part, where the room lets them as they ask; else null. */
  admitted(identity: string, voice: Voice | null): Voice | null {
    if (!voice || !this.#enabled) return null;
    const taken = this.#seats.withVoice(voice.session);
    // A page that returns finds its own session on the seat that was held for it.
    return taken !== null && this.#seats.at(taken)?.identity !== identity ? null : voice;
  }

  /** Hears a client on this seat (null: none); `refuse` is told why the room does not do as they say. */
  onMessage(
    index: number | null,
    member: Member,
    message: Received<'voice' | 'signal'>,
    refuse: (reason: RefusalReason) => void,
  ): void {
    const passes = message.type === 'signal';
    const refusal = passes ? this.#pass(index, message) : this.#change(index, member, message.voice);
    if (refusal) refuse(refusal);
  }

  /** Takes the client in among the voices, or out. */
  #change(index: number | null, member: Member, voice: Voice | null): RefusalReason | null {
    if (!this.#enabled) return 'no-voices';
    if (index === null && voice) return 'no-seat';
    const taken = voice && this.#seats.withVoice(voice.session);
    if (taken !== null && taken !== index) return 'session-taken';
    member.voice = voice;
    if (index !== null) this.#seats.update(index, { voice });
    return null;
  }

  /** Passes a signal on to the page that it is for, with the session that the room knows its sender by. */
  #pass(index: number | null, { to, body }: Received<'signal'>): RefusalReason | null {
    if (!this.#enabled) return 'no-voices';
    const sender = index === null ? null : this.#seats.at(index);
    if (!sender) return 'no-seat';
    const receiver = this.#seats.withVoice(to);
    const client = receiver === null || receiver === index ? null : (this.#seats.at(receiver)?.client ?? null);
    if (!sender.voice || client === null) return 'not-heard';
    this.#host.send(client, { type: 'signal', from: sender.voice.session, body });
    return null;
  }
}
