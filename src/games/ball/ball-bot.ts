import { distance, setVec3, type Vec3, vec3 } from 'threepoint/math';
import type { SimulatedInput } from '../simulated-input';
import type { BallState } from './ball-state';
import { rackPosition, stations } from './stations';

/** A bot's view of the match: the state, and its own player index. */
export interface BotView {
  readonly state: BallState;
  readonly player: number;
  /** The centre of the basket's opening as drawn, arena frame. Default: that of the state. */
  readonly basket?: Vec3;
}

/** A built-in player, which produces hands and buttons for a whole match. */
export interface BallBot {
  /** Returns head, hands (own floor frame) and buttons at `time` [s, not decreasing]. */
  follow(time: number, sight: BotView): SimulatedInput;
}

// Scratch of one call.
const rack = vec3(0, 0, 0);
const mark = vec3(0, 0, 0);

/** Returns the nearest ball in a rack; null: none is within reach, or no round runs. */
export function nearestBall({ state, player }: BotView): number | null {
  if (state.phase !== 'running') return null;
  const station = stations[state.players[player]?.station ?? 0];
  if (!station) return null;
  setVec3(mark, station.position.x, 1, station.position.z);
  let nearest: number | null = null;
  let least = 1;
  for (let ball = 0; ball < state.balls.length; ball++) {
    if (state.balls[ball]?.on !== 'rack') continue;
    const far = distance(rackPosition(ball, state.options.balls, rack), mark);
    if (far >= least) continue;
    nearest = ball;
    least = far;
  }
  return nearest;
}
