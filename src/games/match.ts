import { maxStepSeconds } from 'threepoint/core';
import type { GameRules } from './game-rules';

/** A match in progress: it holds the newest state, and steps ticks from frames. */
export interface Match<State, Action, Event> {
  readonly state: State;
  /** Seconds from the end of the last tick to the newest frame, usually negative; drawing extrapolates by it. */
  readonly lead: number;
  /**
   * Steps every tick that has begun by `time` [s, any monotonic clock; the first call starts tick 0], and returns the
   * events. The actions belong to the tick in which the frame lies, or to the next one if that has been stepped.
   */
  advance(time: number, actions: readonly Action[]): readonly Event[];
}

/** Optional callbacks of a match. */
interface MatchHooks<Action> {
  /** Returns the action with its delay after the start of its tick [s]. */
  delayed?(action: Action, delay: number): Action;
  /** Called before each tick with its actions, which suffice to replay the match. */
  onTick?(actions: readonly Action[]): void;
}

/** Creates a match that plays the rules frame by frame from `start`. */
export function createMatch<State, Action, Event, Options>(
  rules: GameRules<State, Action, Event, Options>,
  start: State,
  hooks: MatchHooks<Action> = {},
): Match<State, Action, Event> {
  let state = start;
  let stepped = 0;
  let startedAt: number | null = null;
  let last = 0;
  let waiting: Action[] = [];

  /** Adds the actions of a frame with their delay in the tick [s]. */
  function queue(actions: readonly Action[], delay: number, due: Action[]): void {
    for (const action of actions) due.push(hooks.delayed ? hooks.delayed(action, delay) : action);
  }

  return {
    get state() {
      return state;
    },
    get lead() {
      return startedAt === null ? 0 : last - startedAt - stepped * rules.tickSeconds;
    },
    advance(time, actions) {
      startedAt ??= time;
      // A longer gap than a frame is a pause, which is removed from the match's time.
      if (time - last > maxStepSeconds + 1e-6 && stepped > 0) startedAt += time - last;
      last = time;
      const now = time - startedAt;
      const tick = Math.floor(now / rules.tickSeconds);
      const inTick = Math.min(Math.max(now - tick * rules.tickSeconds, 0), rules.tickSeconds * (1 - 1e-9));
      const events: Event[] = [];
      if (tick < stepped) queue(actions, 0, waiting);
      while (stepped <= tick) {
        const due = waiting;
        waiting = [];
        if (stepped === tick) queue(actions, inTick, due);
        hooks.onTick?.(due);
        const done = rules.step(state, due);
        state = done.state;
        events.push(...done.events);
        stepped += 1;
      }
      return events;
    },
  };
}
