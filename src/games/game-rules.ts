/**
 * The rules of a game as a reducer with a fixed tick, without clock or outside randomness. The host decides when to
 * step; the same actions in the same ticks always give the same states.
 */
export interface GameRules<State, Action, Event, Options> {
  /** Length of a tick [s]. */
  readonly tickSeconds: number;
  start(players: readonly string[], seed: number, options?: Partial<Options>): State;
  /** Steps one tick: first the actions in their order, then the world. Actions that the rules forbid change nothing. */
  step(state: State, actions: readonly Action[]): { readonly state: State; readonly events: readonly Event[] };
}
