import type { Side, Vec3 } from 'threepoint/math';
import type { Launch } from 'threepoint-games';
import type { BallCue, BallGame, BallRole, Opening } from 'threepoint-games/ball';
import type { MatchFrame } from '../../people/match/match-frame';

/** The position of a ball in each hand, arena frame; null: the hand is not tracked. */
export type Palms = Readonly<Record<Side, Vec3 | null>>;

/** The result of one frame of the ball game, for view, sound and haptics. */
export interface BallFrame extends MatchFrame<BallGame> {
  readonly role: BallRole | null;
  /** The palms by player. They are the same objects in every frame: copy what must stay. */
  readonly palms: readonly Palms[];
  /** The basket where its holder's hands had it last; null: where the state has it. Arena frame. */
  readonly opening: Opening | null;
  readonly cues: readonly BallCue[];
  /** A built-in player moved the user's body: what the match refuses is not the user's mistake. */
  readonly simulated: boolean;
  readonly held: Readonly<Record<Side, number | null>>;
  /** How the ball in the own hand would fly, arena frame; null: no one aims it with a mouse. */
  readonly aim: Launch | null;
}
