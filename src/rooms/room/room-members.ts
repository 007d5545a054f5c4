import type { JoinRequest } from '../protocol/messages';
import type { HostedGame } from './match-policy';
import type { ClientId, RefusalReason, RoomHost } from './room-host';
import type { Member, Seats } from './seats';

export interface RoomMembersOptions {
  readonly seats: Seats;
  readonly host: Pick<RoomHost<HostedGame>, 'disconnect'>;
  /** Every seat belongs to one person, who cannot change it. */
  readonly assigned: boolean;
  /** Called when a seat has become free. */
  onVacated(seat: number): void;
}

/** The clients of a room: who has joined, who takes which seat, and who has to yield. */
export class RoomMembers {
  readonly #options: RoomMembersOptions;
  readonly #members = new Map<ClientId, Member>();

  constructor(options: RoomMembersOptions) {
    this.#options = options;
  }

  get count(): number {
    return this.#members.size;
  }

  /** The number of clients without a seat. */
  get spectators(): number {
    const { seats } = this.#options;
    let spectators = 0;
    for (const client of this.#members.keys()) if (seats.indexOf(client) === null) spectators += 1;
    return spectators;
  }

  of(client: ClientId): Member | undefined {
    return this.#members.get(client);
  }

  /** Ends other connections of this person; the seat is held for the newest one. */
  replaceOlder(identity: string, time: number): void {
    const { seats } = this.#options;
    for (const [older, { identity: owner }] of this.#members) {
      if (owner !== identity) continue;
      const index = seats.indexOf(older);
      if (index !== null) seats.markDisconnected(index, time);
      this.#disconnect(older, 'replaced');
    }
  }

  /** Adds a client, which takes the seat that is held for its person. */
  add(client: ClientId, member: Member, request: JoinRequest, time: number): void {
    const { seats } = this.#options;
    this.#members.set(client, member);
    const held = seats.indexOfIdentity(member.identity);
    if (held !== null && !request.spectate) {
      seats.retake(held, client, member, time);
      return;
    }
    if (held !== null) this.#vacate(held);
    const index = request.spectate ? null : this.#freeSeatFor(request.seat, request.bot);
    if (index !== null) this.#takeSeat(index, client, member, time);
  }

  /** Removes a client whose connection is lost; returns whether it had joined. Its seat is held, a bot's is vacated. */
  lose(client: ClientId, time: number): boolean {
    const { seats } = this.#options;
    const index = seats.indexOf(client);
    if (!this.#members.delete(client)) return false;
    if (index === null) return true;
    if (seats.at(index)?.bot) this.#vacate(index);
    else {
      seats.markDisconnected(index, time);
      seats.setPresence(index, time);
    }
    return true;
  }

  /** Removes a client that leaves, and its seat. */
  leave(client: ClientId): void {
    const index = this.#options.seats.indexOf(client);
    if (index !== null) this.#vacate(index);
    this.#disconnect(client, 'left');
  }

  /** Moves a client to another seat; null: it becomes a spectator, or is one. Returns why that is refused, or null. */
  changeSeat(client: ClientId, member: Member, to: number | null, time: number): RefusalReason | null {
    const { seats, assigned } = this.#options;
    const refusal = assigned ? 'assigned' : seats.refusalOf(to, member, time);
    if (refusal) return refusal;
    const from = seats.indexOf(client);
    if (from !== null) this.#vacate(from);
    member.voice = null;
    if (to !== null) this.#takeSeat(to, client, member, time);
    return null;
  }

  #freeSeatFor(requested: number | null, bot: boolean): number | null {
    const { seats, assigned } = this.#options;
    if (!assigned) return seats.freeFor(requested, bot);
    return requested !== null && seats.isFreeFor(requested, true) ? requested : null;
  }

  /** Gives a client this seat; a bot on it is disconnected. */
  #takeSeat(index: number, client: ClientId, member: Member, time: number): void {
    const { seats } = this.#options;
    const bot = seats.at(index)?.client ?? null;
    seats.vacate(index);
    if (bot !== null) this.#disconnect(bot, 'yielded');
    seats.take(index, client, member, time);
  }

  #vacate(index: number): void {
    this.#options.seats.vacate(index);
    this.#options.onVacated(index);
  }

  #disconnect(client: ClientId, reason: 'left' | 'replaced' | 'yielded'): void {
    this.#members.delete(client);
    this.#options.host.disconnect(client, reason);
  }
}
