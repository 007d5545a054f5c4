import type { Transform } from 'threepoint/math';
import type { HostedGame } from '../room/match-policy';
import type { ClientPolicy } from './client-policy';

/** A client's match: the state that the Room confirmed, and the client's own actions that it has not answered yet. */
export class MatchPrediction<Game extends HostedGame> {
  readonly #policy: ClientPolicy<Game>;
  #confirmed: Game['state'] | null = null;
  #pending: Game['action'][] = [];

  constructor(policy: ClientPolicy<Game>) {
    this.#policy = policy;
  }

  /** The confirmed state; null before the first welcome. */
  get confirmed(): Game['state'] | null {
    return this.#confirmed;
  }

  arenaFromFloor(seat: number): Transform<'arena', 'floor'> {
    return this.#policy.arenaFromFloor(seat, this.#confirmed);
  }

  /** Starts over with this state of the Room. */
  restart(snapshot: Game['snapshot']): void {
    this.#confirmed = this.#policy.unpack(snapshot);
    this.discardPending();
  }

  /** Discards the own actions that the Room has not answered. */
  discardPending(): void {
    this.#pending = [];
  }

  /** Returns the match at this time [s], with the actions of the client on this seat predicted; null: no match. */
  at(matchTime: number, seat: number | null): Game['state'] | null {
    if (!this.#confirmed) return null;
    const state = this.#policy.at(this.#confirmed, matchTime);
    return seat === null ? state : this.#pending.reduce((at, action) => this.#policy.predict(at, seat, action), state);
  }

  /** Adds an own action to the prediction; returns false if there is no match to act in. */
  add(action: Game['action']): boolean {
    if (!this.#confirmed) return false;
    this.#pending.push(action);
    return true;
  }

  /** Applies an event of the Room for the client on this seat; null: a spectator. */
  follow(event: Game['event'], seat: number | null): void {
    if (this.#confirmed) this.#confirmed = this.#policy.follow(this.#confirmed, event);
    if (seat !== null) this.#pending = this.#pending.filter((action) => !this.#policy.answers(event, seat, action));
  }
}
