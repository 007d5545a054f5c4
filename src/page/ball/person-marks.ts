/** What the user wants of another player: not to hear them, or neither to see nor to hear them. */
export type Mark = 'silenced' | 'hidden';

/** A player on a seat, as far as marks need to know them. */
interface Known {
  readonly name: string;
  readonly bot: boolean;
}

const marks: readonly Mark[] = ['silenced', 'hidden'];

/**
 * Whom the user does not hear or see in a room, by seat. A room tells players apart by their seats and names alone: a mark goes with the
 * name to another seat, and waits for it while its person is away.
 */
export class PersonMarks {
  readonly #seats: Readonly<Record<Mark, Set<number>>> = { silenced: new Set(), hidden: new Set() };
  readonly #players: (Known | null)[] = [];
  /** By the name of a person who has left their seat: what they were marked with. */
  readonly #left = new Map<string, readonly Mark[]>();

  /** Seats whose players are not to be seen. */
  get hidden(): ReadonlySet<number> {
    return this.#seats.hidden;
  }

  has(mark: Mark, seat: number): boolean {
    return this.#seats[mark].has(seat);
  }

  /** Nothing is to be heard of the player on this seat. */
  mutes(seat: number): boolean {
    return this.has('silenced', seat) || this.has('hidden', seat);
  }

  set(mark: Mark, seat: number, on: boolean): void {
    if (on) this.#seats[mark].add(seat);
    else this.#seats[mark].delete(seat);
  }

  /** Who sits where now. */
  follow(players: readonly (Known | null)[]): void {
    const changed = [...players.keys()].filter((seat) => {
      const before = this.#players[seat];
      const now = players[seat];
      return before === undefined || before?.name !== now?.name || before?.bot !== now?.bot;
    });
    for (const seat of changed) this.#leave(seat);
    for (const seat of changed) this.#sit(seat, players[seat] ?? null);
  }

  #leave(seat: number): void {
    const player = this.#players[seat];
    if (player === undefined) return;
    const kept = marks.filter((mark) => this.has(mark, seat));
    for (const mark of kept) this.set(mark, seat, false);
    // Bots take each other's names.
    if (player && !player.bot && kept.length > 0) this.#left.set(player.name, kept);
  }

  #sit(seat: number, player: Known | null): void {
    this.#players[seat] = player && { name: player.name, bot: player.bot };
    if (!player || player.bot) return;
    for (const mark of this.#left.get(player.name) ?? []) this.set(mark, seat, true);
    this.#left.delete(player.name);
  }
}
