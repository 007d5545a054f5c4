import type * as v from 'valibot';
import type { HostedGame, MatchPolicy } from './match-policy';

/** A game of a server. `Terms` is what may differ between its rooms; the first person in a room sets it for good. */
export interface RoomKind<Terms extends object = object> {
  /** The schema of the terms that anyone may set. */
  readonly openTerms: v.GenericSchema<unknown, Terms>;
  /** The schema of the terms that only the server may sign, for rooms with assigned seats. */
  readonly assignedTerms: v.GenericSchema<unknown, Terms>;
  /**
   * Creates the policy of a room. `assigned`: every seat is assigned to one person, and a match starts only when all
   * are present.
   */
  createPolicy(terms: Terms, assigned: boolean): MatchPolicy<HostedGame>;
}

/** The games of a server, by name. */
export type RoomKinds = ReadonlyMap<string, RoomKind>;
