/** What the user blocks of another player: the voice, or the voice and the body. */
export type Block = 'silenced' | 'hidden';

/** A player on a seat. */
interface SeatedPlayer {
  readonly name: string;
  readonly bot: boolean;
}

const blocks: readonly Block[] = ['silenced', 'hidden'];

/**
 * The players that the user has muted or hidden, by seat. A room identifies players by seat and name only, so a block
 * moves with the name to another seat, and is kept while its player is away.
 */
export class BlockList {
  readonly #seats: Readonly<Record<Block, Set<number>>> = { silenced: new Set(), hidden: new Set() };
  readonly #players: (SeatedPlayer | null)[] = [];
  /** The blocks of people who have left their seat, by name. */
  readonly #left = new Map<string, readonly Block[]>();
  readonly #visible: unknown[] = [];
  readonly #onChange: () => void;
  #newest: readonly (SeatedPlayer | null)[] | null = null;

  constructor(onChange: () => void = () => undefined) {
    this.#onChange = onChange;
  }

  /** The seats of hidden players. */
  get hidden(): ReadonlySet<number> {
    return this.#seats.hidden;
  }

  has(block: Block, seat: number): boolean {
    return this.#seats[block].has(seat);
  }

  /** Whether the voice of the player on this seat is blocked. */
  mutes(seat: number): boolean {
    return this.has('silenced', seat) || this.has('hidden', seat);
  }

  set(block: Block, seat: number, on: boolean): void {
    this.#mark(block, seat, on);
    this.#onChange();
  }

  /** Returns the bodies that are not hidden. The list is valid until the next call. */
  visible<Body extends { readonly id: number }>(bodies: readonly Body[]): readonly Body[] {
    const visible = this.#visible as Body[];
    visible.length = 0;
    for (let i = 0; i < bodies.length; i++) {
      const body = bodies[i]!;
      if (!this.#seats.hidden.has(body.id)) visible.push(body);
    }
    return visible;
  }

  /** Moves blocks with their players. `players`: by seat; an unchanged list is ignored. */
  update(players: readonly (SeatedPlayer | null)[]): void {
    if (players === this.#newest) return;
    this.#newest = players;
    const changed = [...players.keys()].filter((seat) => {
      const before = this.#players[seat];
      const now = players[seat];
      return before === undefined || before?.name !== now?.name || before?.bot !== now?.bot;
    });
    for (const seat of changed) this.#leave(seat);
    for (const seat of changed) this.#sit(seat, players[seat] ?? null);
    if (changed.length > 0) this.#onChange();
  }

  #mark(block: Block, seat: number, on: boolean): void {
    if (on) this.#seats[block].add(seat);
    else this.#seats[block].delete(seat);
  }

  #leave(seat: number): void {
    const player = this.#players[seat];
    if (player === undefined) return;
    const kept = blocks.filter((block) => this.has(block, seat));
    for (const block of kept) this.#mark(block, seat, false);
    // Bots take each other's names.
    if (player && !player.bot && kept.length > 0) this.#left.set(player.name, kept);
  }

  #sit(seat: number, player: SeatedPlayer | null): void {
    this.#players[seat] = player && { name: player.name, bot: player.bot };
    if (!player || player.bot) return;
    for (const block of this.#left.get(player.name) ?? []) this.#mark(block, seat, true);
    this.#left.delete(player.name);
  }
}
