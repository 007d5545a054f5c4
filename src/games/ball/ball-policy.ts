import type { Transform } from 'threepoint/math';
import type { HostedMatch, MatchPolicy } from 'threepoint-rooms/room';
import { createMatch } from '../match';
import { ballActionFrom, ballKind, type SentBallGame } from './ball-messages';
import { type PackedBall, packBall } from './ball-snapshot';
import type { BallAction, BallEvent, BallInput, BallOptions, BallState } from './ball-state';
import { ballRules } from './rules';
import { arenaFromSeatFloor, rotationForRound, stations } from './stations';

/** The types of the ball game as a Room hosts it. */
export interface BallGame extends SentBallGame {
  readonly state: BallState;
  readonly action: BallAction;
}

export interface BallPolicyOptions extends Partial<BallOptions> {
  readonly seed?: number;
}

/** The match policy of the ball game: three seats, for two throwers and the basket holder. */
export class BallPolicy implements MatchPolicy<BallGame> {
  readonly kind = ballKind;
  readonly seats = stations.length;
  readonly tickSeconds = ballRules.tickSeconds;
  readonly #options: Partial<BallOptions>;
  readonly #seed: number;

  constructor({ seed = 0, ...options }: BallPolicyOptions = {}) {
    this.#options = options;
    this.#seed = seed;
  }

  start(rotation: number, onTick: (actions: readonly BallInput[]) => void): HostedMatch<BallGame> {
    const players = stations.map((_, seat) => `seat ${seat}`);
    const options = { ...this.#options, rotation: (this.#options.rotation ?? 0) + rotation };
    return createMatch(ballRules, ballRules.start(players, this.#seed, options), { onTick });
  }

  nextRoles({ players }: BallState, rotate: boolean): number | null {
    const taken = players.filter(({ present }) => present).map(({ station }) => station);
    return rotationForRound(taken, rotate);
  }

  snapshot(state: BallState): PackedBall {
    return packBall(state);
  }

  readAction(value: unknown): BallAction | null {
    return ballActionFrom(value);
  }

  refusalInPause(player: number, { sequence }: BallAction): BallEvent {
    return { type: 'refused', player, sequence, reason: 'phase' };
  }

  refusalOf(event: BallEvent): { readonly player: number; readonly reason: string } | null {
    return event.type === 'refused' ? event : null;
  }

  arenaFromFloor(seat: number, state: BallState): Transform<'arena', 'floor'> {
    return arenaFromSeatFloor(seat, state);
  }
}
