import { defaultAvatar } from 'threepoint/core';
import type { ClientMessage, JoinRequest } from '../protocol/messages';
import { maxVoiceSeats, type Voice } from '../protocol/voice-messages';
import type { HostedGame } from './match-policy';
import type { RejectionReason, RoomHost } from './room-host';
import { allowedMoves, type Member, type Seats } from './seats';

export type Received<Type extends ClientMessage['type']> = Extract<ClientMessage, { type: Type }>;

interface MemberProfilesOptions {
  /** All members look alike: an avatar of their own would identify them. */
  readonly assigned: boolean;
  /** The room's host allows voices; a room with more than `maxVoiceSeats` seats has none even then. */
  readonly voices: boolean;
}

/**
 * What the members of a room show of themselves to the others: body measures, avatar and voice. Sound never passes
 * through the room: pages send it to each other, and the room forwards the signals by which they connect. A spectator
 * has no seat, and therefore no voice.
 */
export class MemberProfiles {
  readonly #seats: Seats;
  readonly #host: Pick<RoomHost<HostedGame>, 'send'>;
  readonly #assigned: boolean;
  readonly #hasVoices: boolean;

  constructor(seats: Seats, host: Pick<RoomHost<HostedGame>, 'send'>, { assigned, voices }: MemberProfilesOptions) {
    this.#seats = seats;
    this.#host = host;
    this.#assigned = assigned;
    this.#hasVoices = voices && seats.count <= maxVoiceSeats;
  }

  /** Returns the member that a client becomes by joining. */
  admit(identity: string, { name, bot, calibration, avatar, voice, spectate }: JoinRequest): Member {
    return {
      identity,
      name,
      bot,
      calibration,
      avatar: this.#assigned ? defaultAvatar : avatar,
      voice: spectate ? null : this.#admittedVoice(identity, voice),
      moves: allowedMoves(),
    };
  }

  /** Applies a message of a member on this seat (null: a spectator). Returns why it is refused, or null. */
  onMessage(
    index: number | null,
    member: Member,
    message: Received<'calibration' | 'wear' | 'voice' | 'signal'>,
  ): RejectionReason | null {
    switch (message.type) {
      case 'calibration':
        member.calibration = message.calibration;
        break;
      case 'wear':
        if (this.#assigned) return 'assigned';
        if (member.avatar === message.avatar) return null;
        member.avatar = message.avatar;
        break;
      case 'voice': {
        const rejection = this.#voiceRejection(index, message.voice);
        if (rejection) return rejection;
        member.voice = message.voice;
        break;
      }
      case 'signal':
        return this.#forwardSignal(index, message);
    }
    if (index !== null) this.#seats.reportChange(index);
    return null;
  }

  /** Returns the voice of a joining person; null where the room has no voices or the session is taken. */
  #admittedVoice(identity: string, voice: Voice | null): Voice | null {
    if (!voice || !this.#hasVoices) return null;
    const taken = this.#seats.withVoice(voice.session);
    // A page that reconnects finds its own session on the held seat.
    return taken !== null && this.#seats.at(taken)?.member.identity !== identity ? null : voice;
  }

  #voiceRejection(index: number | null, voice: Voice | null): RejectionReason | null {
    if (!this.#hasVoices) return 'no-voices';
    if (index === null && voice) return 'no-seat';
    const taken = voice && this.#seats.withVoice(voice.session);
    return taken !== null && taken !== index ? 'session-taken' : null;
  }

  /** Forwards a signal to the page that it names, with the sender's own session. */
  #forwardSignal(index: number | null, { to, body }: Received<'signal'>): RejectionReason | null {
    if (!this.#hasVoices) return 'no-voices';
    const sender = index === null ? null : this.#seats.at(index);
    if (!sender) return 'no-seat';
    const receiver = this.#seats.withVoice(to);
    const client = receiver === null || receiver === index ? null : (this.#seats.at(receiver)?.client ?? null);
    if (!sender.member.voice || client === null) return 'no-receiver';
    this.#host.send(client, { type: 'signal', from: sender.member.voice.session, body });
    return null;
  }
}
