import type { BallEvent, BallLocation, BallState, Basket, TimedLaunch } from './ball-state';
import { firstBasketContact } from './basket-collision';
import { floorBounceOf, floorContactTime } from './flight';
import { round, roundedLaunch, type Step, withBall } from './state-changes';

type InAir = Extract<BallLocation, { on: 'air' }>;

/** Returns the next location of a flying ball while the basket moves, and adds the events; null: it flies on. */
function nextLocation(
  ball: number,
  location: InAir,
  score: number,
  basket: BasketMotion,
  events: BallEvent[],
): BallLocation | null {
  const { thrower, launch } = location;
  const meeting = location.missed || !basket.isHeld ? null : firstBasketContact(launch, basket.from, basket.to);
  if (meeting?.kind === 'caught') {
    events.push({ type: 'caught', ball, player: thrower, at: round(meeting.time), score: score + 1 });
    return { on: 'basket', thrower };
  }
  if (meeting) {
    const bounced = afterFlight(roundedLaunch(meeting.launch), launch);
    events.push({ type: 'bounced', ball, off: 'basket', launch: bounced });
    return { ...location, launch: bounced };
  }
  const time = floorContactTime(launch);
  if (time > basket.to.at) return null;
  const { launch: after, rolls } = floorBounceOf(launch, Math.max(time, launch.time));
  const bounced = afterFlight(roundedLaunch(after), launch);
  if (!location.missed) events.push({ type: 'missed', ball, player: thrower });
  events.push(
    rolls ? { type: 'rolls', ball, launch: bounced } : { type: 'bounced', ball, off: 'floor', launch: bounced },
  );
  return rolls ? { on: 'floor', launch: bounced, thrower } : { on: 'air', launch: bounced, thrower, missed: true };
}

/** A movement of the basket from one pose to another. */
interface BasketMotion {
  readonly from: Basket;
  readonly to: Basket;
  /** Whether the holder is there; otherwise balls fly through the basket. */
  readonly isHeld: boolean;
}

/** Decides the flight of every ball while the basket moves to `to`. Without its holder it catches nothing. */
export function resolveFlights(state: BallState, to: Basket, isHeld = true): Step {
  const way = { from: state.basket, to, isHeld };
  const events: BallEvent[] = [];
  let next: BallState = { ...state, basket: to };
  for (let ball = 0; ball < state.balls.length; ball++) {
    let location: BallLocation | null = state.balls[ball]!;
    while (location?.on === 'air') {
      location = nextLocation(ball, location, next.score, way, events);
      if (location) next = withBall(next, ball, location);
      if (location?.on === 'basket') next = { ...next, score: next.score + 1 };
    }
  }
  return { state: next, events };
}

/** Returns a bounce whose rounded time is later than that of the flight before it. */
const afterFlight = (bounce: TimedLaunch, flight: TimedLaunch): TimedLaunch =>
  bounce.time > flight.time ? bounce : { ...bounce, time: round(flight.time + 1e-4) };
