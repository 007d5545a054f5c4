import type { JoinRequest } from '../protocol/messages';
import type { HostedGame } from './match-policy';
import type { ClientId, RejectionReason, RoomHost } from './room-host';
import type { Member, Seats } from './seats';

/** The clients of a room: who has joined, who takes which seat, and who has to yield. */
export class RoomMembers {
  readonly #seats: Seats;
  readonly #host: Pick<RoomHost<HostedGame>, 'disconnect'>;
  readonly #assigned: boolean;
  readonly #members = new Map<ClientId, Member>();

  /** `assigned`: every seat belongs to one person, who cannot change it. */
  constructor(seats: Seats, host: Pick<RoomHost<HostedGame>, 'disconnect'>, assigned: boolean) {
    this.#seats = seats;
    this.#host = host;
    this.#assigned = assigned;
  }

  get count(): number {
    return this.#members.size;
  }

  get spectators(): number {
    let spectators = 0;
    for (const client of this.#members.keys()) if (this.#seats.indexOf(client) === null) spectators += 1;
    return spectators;
  }

  of(client: ClientId): Member | undefined {
    return this.#members.get(client);
  }

  /** Ends other connections of this person; the seat is held for the newest one. */
  replaceOlder(identity: string, time: number): void {
    for (const [older, { identity: owner }] of this.#members) {
      if (owner !== identity) continue;
      const index = this.#seats.indexOf(older);
      if (index !== null) this.#seats.markDisconnected(index, time);
      this.#disconnect(older, 'replaced');
    }
  }

  /** Adds a client, which takes the seat that is held for its person. */
  add(client: ClientId, member: Member, request: JoinRequest, time: number): void {
    this.#members.set(client, member);
    const held = this.#seats.indexOfIdentity(member.identity);
    if (held !== null && !request.spectate) {
      this.#seats.retake(held, client, member, time);
      return;
    }
    if (held !== null) this.#seats.vacate(held);
    const index = request.spectate ? null : this.#freeSeatFor(request.seat, request.bot);
    if (index !== null) this.#takeSeat(index, client, member, time);
  }

  /** Removes a client whose connection is lost; returns whether it had joined. Its seat is held, a bot's is vacated. */
  lose(client: ClientId, time: number): boolean {
    const index = this.#seats.indexOf(client);
    if (!this.#members.delete(client)) return false;
    if (index === null) return true;
    if (this.#seats.at(index)?.member.bot) this.#seats.vacate(index);
    else {
      this.#seats.markDisconnected(index, time);
      this.#seats.setPresence(index, time);
    }
    return true;
  }

  /** Removes a client that leaves, and its seat. */
  leave(client: ClientId): void {
    const index = this.#seats.indexOf(client);
    if (index !== null) this.#seats.vacate(index);
    this.#disconnect(client, 'left');
  }

  /** Moves a client to another seat; null: it becomes a spectator, or is one. Returns why that is refused, or null. */
  changeSeat(client: ClientId, member: Member, to: number | null, time: number): RejectionReason | null {
    const rejection = this.#assigned ? 'assigned' : this.#seats.refusalOf(to, member, time);
    if (rejection) return rejection;
    const from = this.#seats.indexOf(client);
    if (from !== null) this.#seats.vacate(from);
    member.voice = null;
    if (to !== null) this.#takeSeat(to, client, member, time);
    return null;
  }

  #freeSeatFor(requested: number | null, bot: boolean): number | null {
    if (!this.#assigned) return this.#seats.freeFor(requested, bot);
    return requested !== null && this.#seats.isFreeFor(requested, true) ? requested : null;
  }

  /** Gives a client this seat; a bot on it is disconnected. */
  #takeSeat(index: number, client: ClientId, member: Member, time: number): void {
    const bot = this.#seats.at(index)?.client ?? null;
    if (bot !== null) this.#disconnect(bot, 'yielded');
    this.#seats.take(index, client, member, time);
  }

  #disconnect(client: ClientId, reason: 'left' | 'replaced' | 'yielded'): void {
    this.#members.delete(client);
    this.#host.disconnect(client, reason);
  }
}
