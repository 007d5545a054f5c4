/**
 * A game as a reducer with a fixed tick: no clock, no chance from outside. Its host decides when to step; the same
 * actions in the same ticks always give the same states.
 */
export interface GameRules<State, Action, Event, Options> {
  /** Seconds of the match that one step takes. */
  readonly tickSeconds: number;
  start(players: readonly string[], seed: number, options?: Partial<Options>): State;
  /** One tick: first the actions, in their order, then the world. Actions that the rules forbid change nothing. */
  step(state: State, actions: readonly Action[]): { readonly state: State; readonly events: readonly Event[] };
}
