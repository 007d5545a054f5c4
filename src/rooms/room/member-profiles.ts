import { defaultAvatar } from 'threepoint/core/body/built-in-bodies';
import type { ClientMessage, JoinRequest } from '../protocol/messages';
import type { HostedGame } from './match-policy';
import type { RefusalReason, RoomHost } from './room-host';
import { RoomVoices } from './room-voices';
import { allowedMoves, type Member, type Seats } from './seats';

type ProfileMessage = Extract<ClientMessage, { type: 'calibration' | 'wear' | 'voice' | 'signal' }>;

export interface MemberProfilesOptions {
  /** All members look alike: an avatar of their own would identify them. */
  readonly assigned: boolean;
  readonly voices: boolean;
}

/** What the members of a room show of themselves to the others: body measures, avatar and voice. */
export class MemberProfiles {
  readonly #seats: Seats;
  readonly #assigned: boolean;
  readonly #voices: RoomVoices;

  constructor(seats: Seats, host: Pick<RoomHost<HostedGame>, 'send'>, { assigned, voices }: MemberProfilesOptions) {
    this.#seats = seats;
    this.#assigned = assigned;
    this.#voices = new RoomVoices(seats, voices, host);
  }

  /** Returns the member that a client becomes by joining. */
  admit(identity: string, { name, bot, calibration, avatar, voice, spectate }: JoinRequest): Member {
    return {
      identity,
      name,
      bot,
      calibration,
      avatar: this.#assigned ? defaultAvatar : avatar,
      voice: spectate ? null : this.#voices.admitted(identity, voice),
      moves: allowedMoves(),
    };
  }

  /** Applies a message of a member on this seat (null: a spectator). Returns why it is refused, or null. */
  onMessage(index: number | null, member: Member, message: ProfileMessage): RefusalReason | null {
    switch (message.type) {
      case 'calibration':
        member.calibration = message.calibration;
        if (index !== null) this.#seats.update(index, { calibration: message.calibration });
        return null;
      case 'wear':
        if (this.#assigned) return 'assigned';
        member.avatar = message.avatar;
        if (index !== null && this.#seats.at(index)?.avatar !== message.avatar) {
          this.#seats.update(index, { avatar: message.avatar });
        }
        return null;
      default:
        return this.#voices.onMessage(index, member, message);
    }
  }
}
