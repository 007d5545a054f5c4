import type { Transform } from 'threepoint/math';
import type { RoomMessage } from '../protocol/messages';
import type { HostedGame } from '../room/match-policy';

/** What a client needs of its Room's game: the counterpart of MatchPolicy. */
export interface ClientPolicy<Game extends HostedGame> {
  /** The name of the game, as in its MatchPolicy. */
  readonly kind: string;
  /** Returns a message of the Room, checked field by field; null for anything else. */
  readMessage(value: unknown): RoomMessage<Game> | null;
  /** Returns the state that the Room sent as this snapshot; null where it is no state of the game. */
  unpack(snapshot: Game['snapshot']): Game['state'] | null;
  /** Returns the state after an event of the Room; an event that arrives twice changes nothing. */
  follow(state: Game['state'], event: Game['event']): Game['state'];
  /** Returns the state at this time of the match [s], as far as it follows from the clock alone. */
  at(state: Game['state'], matchTime: number): Game['state'];
  /** Returns the state after the player's own action, if the rules allow it; otherwise the state as it is. */
  predict(state: Game['state'], seat: number, action: Game['action']): Game['state'];
  /** Returns whether this event is the Room's answer to that action of the player. */
  answers(event: Game['event'], seat: number, action: Game['action']): boolean;
  /** Returns where the floor of a seat lies in the arena; `state` null: no match is known yet. */
  arenaFromFloor(seat: number, state: Game['state'] | null): Transform<'arena', 'floor'>;
}
