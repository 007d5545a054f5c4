import { add, addScaled, normalise, type Vec3, vec3 } from 'threepoint/math';
import type {
  ArcheryAction,
  ArcheryEvent,
  ArcheryOptions,
  ArcheryState,
} from '../../../src/games/archery/archery-state';
import { arrowLength } from '../../../src/games/archery/bow';
import { releaseDirection } from '../../../src/games/archery/flight';
import { archeryRules } from '../../../src/games/archery/rules';

export const { tickSeconds } = archeryRules;

export const start = (options: Partial<ArcheryOptions> = {}, matchSeed = 7) =>
  archeryRules.start(['archer'], matchSeed, options);

export const nockOf = (state: ArcheryState): Vec3 => add(state.head, vec3(0.1, -0.1, -0.1));

/** A release that hits the middle of a target, or `miss` [m] beside it. */
export function shotAt(state: ArcheryState, target: number, miss = vec3(0, 0, 0), draw = 0.5): ArcheryAction {
  const nock = nockOf(state);
  const direction = releaseDirection(add(state.targets[target]!.centre, miss), nock, draw)!;
  return { type: 'release', position: addScaled(nock, direction, arrowLength), direction, draw, delay: 0 };
}

/** Past everything, into the net. */
export const wideOf = (state: ArcheryState): ArcheryAction => shotAt(state, 0, vec3(0, 0.8, 0));

/** Up into the sky: 9 s of flight. */
export function highShot(state: ArcheryState): ArcheryAction {
  const direction = normalise(vec3(0, 1, -0.05));
  const position = addScaled(nockOf(state), direction, arrowLength);
  return { type: 'release', position, direction, draw: 0.6, delay: 0 };
}

/** A match that is stepped tick by tick. */
export function told(first: ArcheryState) {
  const events: ArcheryEvent[] = [];
  let state = first;
  const step = (...actions: ArcheryAction[]) => {
    const done = archeryRules.step(state, actions);
    state = done.state;
    events.push(...done.events);
  };
  const pass = (seconds: number) => {
    for (let i = 0; i < Math.round(seconds / tickSeconds); i++) step();
  };
  return {
    get state() {
      return state;
    },
    events,
    step,
    pass,
    shoot(target: number) {
      step(shotAt(state, target));
      pass(1);
    },
    happened: <T extends ArcheryEvent['type']>(type: T) =>
      events.filter((event): event is Extract<ArcheryEvent, { type: T }> => event.type === type),
  };
}
