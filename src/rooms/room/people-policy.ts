import { identity, vec3 } from 'threepoint/math';
import * as v from 'valibot';
import { maxSeats } from '../protocol/messages';
import type { HostedGame, HostedMatch, MatchAction, MatchPolicy, MatchState } from './match-policy';
import type { RoomKind } from './room-kind';

/** A room without a game: people who see each other. It has no actions and no events. */
export interface People extends HostedGame {
  readonly state: MatchState;
  readonly action: never;
  readonly event: never;
  readonly snapshot: null;
}

/** The name by which pages request a room without a game. */
export const peopleKind = 'people';

/** The floors of all seats lie where the scene's origin is. */
export const sharedFloor = { position: vec3(0, 0, 0), orientation: identity } as const;

export const noMatchState: MatchState = { tick: 0, phase: 'ready', players: [] };

/** Nothing happens in it: its state is that of its seats. */
class NoMatch implements HostedMatch<People> {
  readonly state = noMatchState;
  readonly lead = 0;

  advance(_time: number, _actions: readonly MatchAction<People>[]): readonly never[] {
    return [];
  }
}

/** The policy of a room without a game, with so many seats (16 at most). */
const peoplePolicy = (seats: number = maxSeats): MatchPolicy<People> => ({
  kind: peopleKind,
  seats,
  tickSeconds: 1,
  start: () => new NoMatch(),
  next: () => null,
  snapshot: () => null,
  readAction: () => null,
  refusalInPause: () => {
    throw new Error('A room without a game has no actions to refuse.');
  },
  refusalOf: () => null,
  arenaFromFloor: () => sharedFloor,
});

const noTerms = v.strictObject({});

/** Returns rooms without a game for a server, with so many seats. */
export const peopleRoomKind = (seats?: number): RoomKind => ({
  openTerms: noTerms,
  assignedTerms: noTerms,
  createPolicy: () => peoplePolicy(seats),
});
