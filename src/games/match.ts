import type { GameRules } from './game-rules';

/** A match in progress: the newest state and the way from frames to ticks. */
export interface Match<State, Action, Event> {
  readonly state: State;
  /** Seconds from the end of the last tick stepped to the newest frame, mostly below 0: what is drawn is drawn for then. */
  readonly lead: number;
  /**
   * Steps every tick that has begun by `time` [s, any monotonic clock; the first call is the start of tick 0] and returns what
   * happened. The actions belong to this frame: to the tick it lies in, or where that has been stepped already, to the next.
   */
  advance(time: number, actions: readonly Action[]): readonly Event[];
}

/** What a match can be asked to tell and how its actions learn where in their tick they lie. */
export interface MatchHooks<Action> {
  /** The same action, `delay` [s] into its tick. */
  delayed?(action: Action, delay: number): Action;
  /** Hears of each tick before it is stepped: enough to play the match again. */
  onTick?(actions: readonly Action[]): void;
}

/** After a pause of more than this the match goes on where it stood, instead of catching up in one frame [s]. */
const longestGap = 1;

/** Plays the rules frame by frame from `start`. */
export function createMatch<State, Action, Event, Options>(
  rules: GameRules<State, Action, Event, Options>,
  start: State,
  hooks: MatchHooks<Action> = {},
): Match<State, Action, Event> {
  let state = start;
  let stepped = 0;
  let zero: number | null = null;
  let last = 0;
  let waiting: Action[] = [];

  /** Adds the actions of a frame, `delay` [s] into their tick. */
  function place(actions: readonly Action[], delay: number, due: Action[]): void {
    for (const action of actions) due.push(hooks.delayed ? hooks.delayed(action, delay) : action);
  }

  return {
    get state() {
      return state;
    },
    get lead() {
      return zero === null ? 0 : last - zero - stepped * rules.tickSeconds;
    },
    advance(time, actions) {
      zero ??= time;
      // A frame's own duration was at most a tick or two: a pause is cut out of the match's time.
      if (time - last > longestGap && stepped > 0) zero += time - last;
      last = time;
      const now = time - zero;
      const tick = Math.floor(now / rules.tickSeconds);
      const inTick = Math.min(Math.max(now - tick * rules.tickSeconds, 0), rules.tickSeconds * (1 - 1e-9));
      const events: Event[] = [];
      if (tick < stepped) place(actions, 0, waiting);
      while (stepped <= tick) {
        const due = waiting;
        waiting = [];
        if (stepped === tick) place(actions, inTick, due);
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
