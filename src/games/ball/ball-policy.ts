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

interface BallPolicyOptions extends Partial<BallOptions> {
  readonly seed?: number;
  /** See `MatchPolicy.waitSeconds`. */
  readonly waitSeconds?: number;
}

const seatNames = stations.map((_, seat) => `seat ${seat}`);

/** The match policy of the ball game: three seats, for two throwers and the basket holder. */
export class BallPolicy implements MatchPolicy<BallGame> {
  readonly kind = ballKind;
  readonly seats = stations.length;
  readonly tickSeconds = ballRules.tickSeconds;
  readonly waitSeconds?: number;
  readonly #options: Partial<BallOptions>;
  readonly #seed: number;

  constructor({ seed = 0, waitSeconds, ...options }: BallPolicyOptions = {}) {
    this.#options = options;
    this.#seed = seed;
    if (waitSeconds !== undefined) this.waitSeconds = waitSeconds;
  }

  start(onTick: (actions: readonly BallInput[]) => void): HostedMatch<BallGame> {
    return createMatch(ballRules, ballRules.start(seatNames, this.#seed, this.#options), { onTick });
  }

  next(
    { options, players, rotate }: BallState,
    onTick: (actions: readonly BallInput[]) => void,
  ): HostedMatch<BallGame> | null {
    const taken = players.filter(({ present }) => present).map(({ station }) => station);
    const movedOn = rotationForRound(taken, rotate);
    if (movedOn === null) return null;
    const start = ballRules.start(seatNames, this.#seed, { ...options, rotation: options.rotation + movedOn });
    return createMatch(ballRules, { ...start, rotate }, { onTick });
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
