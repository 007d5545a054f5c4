import { createMatch } from 'threepoint-games';
import { type ClientPolicy, type MatchPolicy, type RoomKind, roomMessageReader } from 'threepoint-rooms/room';
import * as v from 'valibot';
import {
  floorOf,
  type TouchAction,
  type TouchEvent,
  type TouchOptions,
  type TouchState,
  touchAction,
  touchEvent,
  touchRules,
  touchState,
} from './touch-rules';

export interface TouchGame {
  readonly state: TouchState;
  readonly action: TouchAction;
  readonly event: TouchEvent;
  readonly snapshot: TouchState;
}

const kind = 'touch';

export const touchPolicy = (options: Partial<TouchOptions> = {}, seed = 0): MatchPolicy<TouchGame> => ({
  kind,
  seats: 2,
  tickSeconds: touchRules.tickSeconds,
  start: (onTick) => createMatch(touchRules, touchRules.start([], seed, options), { onTick }),
  next({ players }, onTick) {
    const start = touchRules.start([], seed, options);
    const seated = start.players.map((player, seat) => ({ ...player, present: players[seat]?.present ?? false }));
    return createMatch(touchRules, { ...start, players: seated }, { onTick });
  },
  snapshot: (state) => state,
  readAction(value) {
    const { success, output } = v.safeParse(touchAction, value);
    return success ? (output as TouchAction) : null;
  },
  refusalInPause: (player) => ({ type: 'refused', player, state: touchRules.start([], seed, options) }),
  refusalOf: ({ type, player }) => (type === 'refused' && player !== null ? { player, reason: 'not lit' } : null),
  arenaFromFloor: floorOf,
});

export const touchClientPolicy: ClientPolicy<TouchGame> = {
  kind,
  readMessage: roomMessageReader<TouchGame>(kind, touchState, touchEvent),
  unpack: (state) => state,
  follow: (before, { type, state }) => (type === 'refused' ? before : state),
  at: (state, matchTime) => ({ ...state, tick: Math.max(0, Math.floor(matchTime / touchRules.tickSeconds)) }),
  predict: (state) => state,
  answers: ({ type, player }, seat) => player === seat && (type === 'touched' || type === 'refused'),
  arenaFromFloor: floorOf,
};

const seconds = v.exactOptional(v.pipe(v.number(), v.minValue(1), v.maxValue(3600)));
const terms = v.strictObject({ seconds, waitSeconds: seconds });

export const touchRoomKind = (defaultSeconds: number): RoomKind<v.InferOutput<typeof terms>> => ({
  openTerms: terms,
  assignedTerms: terms,
  createPolicy: ({ waitSeconds = 60, ...given }, everySeat) => ({
    ...touchPolicy({ seconds: defaultSeconds, ...given, everySeat }),
    ...(everySeat && { waitSeconds }),
  }),
});
