import { type Vec3, vec3 } from 'threepoint/math';
import type { BallEvent, BallLocation, BallPlayer, BallState, TimedLaunch } from './ball-state';

/** A state and the events that led to it. */
export type Step = { readonly state: BallState; readonly events: readonly BallEvent[] };

const nothing: readonly never[] = [];

export const unchanged = (state: BallState): Step => ({ state, events: nothing });

/** Rounds a number of a state to 0.1 mm or 0.1 ms. */
export const round = (value: number): number => Math.round(value * 1e4) / 1e4;
export const rounded = ({ x, y, z }: Vec3): Vec3 => vec3(round(x), round(y), round(z));
export const roundedLaunch = ({ time, position, velocity }: TimedLaunch): TimedLaunch => ({
  time: round(time),
  position: rounded(position),
  velocity: rounded(velocity),
});

/** Returns a copy of the list with one item replaced. */
function withItem<T>(items: readonly T[], index: number, item: T): readonly T[] {
  const changed = items.slice();
  if (index < changed.length) changed[index] = item;
  return changed;
}

export function withPlayer(state: BallState, index: number, change: Partial<BallPlayer>): BallState {
  const player = state.players[index];
  return player ? { ...state, players: withItem(state.players, index, { ...player, ...change }) } : state;
}

export const withBall = (state: BallState, ball: number, location: BallLocation): BallState =>
  ball < state.balls.length ? { ...state, balls: withItem(state.balls, ball, location) } : state;
