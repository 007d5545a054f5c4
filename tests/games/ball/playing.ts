import { add, addScaled, normalise, type Pose, scale, subtract, type Vec3, vec3 } from 'threepoint/math';
import type { BallAction, BallEvent, BallInput, BallOptions, BallState } from '../../../src/games/ball/ball-state';
import { ballRules } from '../../../src/games/ball/rules';
import { rackPosition, stations } from '../../../src/games/ball/stations';
import { gravity } from '../../../src/games/ballistics';
import { wristAround } from '../../../src/games/fist';

export const { tickSeconds } = ballRules;

/** The seats of the two throwers and the holder while roles are not rotated. */
export const [leftThrower, rightThrower, holder] = [0, 1, 2] as const;

export const headOf = (player: number): Vec3 => add(stations[player]!.position, vec3(0, 1.6, 0));

/** A thrower who stands at the station with both fists there. */
export const stand = (player: number, at: number, left: Vec3, right = left): BallInput => ({
  type: 'pose',
  player,
  at,
  head: headOf(player),
  left: wristAround('left', left, vec3(0, 0, -1), vec3(0, 1, 0)),
  right: wristAround('right', right, vec3(0, 0, -1), vec3(0, 1, 0)),
});

/** The holder's hands round a basket whose opening is there and looks that way. */
export function hold(at: number, opening: Vec3, normal = vec3(0, 1, 0)): BallInput {
  const across = normalise(subtract(vec3(-1, 0, 0), scale(normal, -normal.x)));
  const hand = (side: 'left' | 'right'): Pose<'arena'> =>
    wristAround(side, addScaled(opening, across, side === 'left' ? -0.22 : 0.22), vec3(0, 0, 1), normal);
  return { type: 'pose', player: holder, at, head: headOf(holder), left: hand('left'), right: hand('right') };
}

/** In front of the holder, at the height of the belly. */
export const inFront = add(stations[holder]!.position, vec3(0, 1.1, 0.45));

/** The velocity that brings a ball from one place to another in this time [s]. */
export const velocityTo = (from: Vec3, to: Vec3, seconds: number): Vec3 =>
  addScaled(scale(subtract(to, from), 1 / seconds), vec3(0, 1, 0), 0.5 * gravity * seconds);

type Throw = Extract<BallAction, { type: 'throw' }>;

/** A match that is stepped tick by tick; all players are present, and ready unless `ready` is false. */
export function told(options: Partial<BallOptions> = {}, ready = true) {
  const events: BallEvent[] = [];
  const log: (readonly BallInput[])[] = [];
  let state: BallState = ballRules.start(['ann', 'ben', 'cal'], 1, options);
  const sequence = [0, 0, 0];
  const step = (...actions: BallInput[]) => {
    log.push(actions);
    const done = ballRules.step(state, actions);
    state = done.state;
    events.push(...done.events);
    return done.events;
  };
  const now = () => state.tick * tickSeconds;
  const pass = (seconds: number) => {
    for (let i = 0; i < Math.round(seconds / tickSeconds); i++) step(hold(now(), inFront));
  };
  type Unnumbered = BallAction extends infer D ? (D extends BallAction ? Omit<D, 'sequence'> : never) : never;
  const action = (player: number, what: Unnumbered): BallInput => {
    sequence[player]! += 1;
    return { ...what, player, sequence: sequence[player]! } as BallInput;
  };
  const release = (player: number): Vec3 => addScaled(headOf(player), vec3(0, 0, -1), 0.5);
  const take = (player: number, ball: number, side: 'left' | 'right' = 'right') =>
    step(
      hold(now(), inFront),
      stand(player, now(), rackPosition(ball, state.options.balls)),
      action(player, { type: 'grab', side, ball }),
    );
  /** Lets a player who stands at their station throw the ball in their right hand, as the change says. */
  const hurl = (player: number, ball: number, change: Partial<Throw> = {}) => {
    const position = release(player);
    const velocity = velocityTo(position, inFront, 1);
    return step(
      hold(now(), inFront),
      stand(player, now(), position),
      action(player, { type: 'throw', side: 'right', ball, at: now(), position, velocity, ...change }),
    );
  };
  const toss = (player: number, ball: number, to: Vec3, seconds = 1, side: 'left' | 'right' = 'right') =>
    hurl(player, ball, { side, velocity: velocityTo(release(player), to, seconds) });
  if (ready) {
    step(...[0, 1, 2].map((player): BallInput => ({ type: 'join', player })));
    step(hold(0, inFront), ...[0, 1, 2].map((player): BallInput => ({ type: 'ready', player, ready: true })));
  }
  return {
    get state() {
      return state;
    },
    now,
    events,
    log,
    step,
    pass,
    action,
    take,
    hurl,
    toss,
    happened: <T extends BallEvent['type']>(type: T) =>
      events.filter((event): event is Extract<BallEvent, { type: T }> => event.type === type),
    refusals: () => events.flatMap((event) => (event.type === 'refused' ? [event.reason] : [])),
  };
}
