import { identity, vec3 } from 'threepoint/math';
import { createMatch } from 'threepoint-games';
import * as v from 'valibot';
import type { ClientPolicy } from '../../../src/rooms/client/client-policy';
import { roomMessageReader } from '../../../src/rooms/protocol/messages';
import type {
  HostedGame,
  HostedMatch,
  MatchAction,
  MatchPolicy,
  MatchState,
} from '../../../src/rooms/room/match-policy';
import type { RoomKind } from '../../../src/rooms/room/room-kind';

interface CountingState extends MatchState {
  readonly total: number;
  readonly players: readonly {
    readonly present: boolean;
    readonly ready: boolean;
    readonly headHeight: number | null;
  }[];
}
type CountingEvent =
  | { readonly type: 'counted'; readonly player: number; readonly total: number }
  | { readonly type: 'refused'; readonly player: number; readonly reason: string };

/** Players count to a number together, each step the next. */
export interface CountingGame extends HostedGame {
  readonly state: CountingState;
  readonly action: { readonly type: 'count'; readonly to: number };
  readonly event: CountingEvent;
  readonly snapshot: { readonly total: number };
}

/** The name by which a relay's clients ask for a room of this game. */
export const countingKind = 'counting';
const tickSeconds = 0.1;

function stepped(goal: number, state: CountingState, actions: readonly MatchAction<CountingGame>[]) {
  const events: CountingEvent[] = [];
  const players = state.players.map((player) => ({ ...player }));
  let { phase, total } = state;
  for (const action of actions) {
    const player = 'player' in action ? players[action.player] : undefined;
    if (action.type === 'join') Object.assign(player!, { present: true, ready: false });
    if (action.type === 'leave') Object.assign(player!, { present: false });
    if (action.type === 'ready') Object.assign(player!, { ready: action.ready });
    if (action.type === 'silent') Object.assign(player!, { headHeight: null });
    if (action.type === 'pose') Object.assign(player!, { headHeight: action.head.y });
    if (action.type !== 'count') continue;
    if (phase !== 'running' || action.to !== total + 1) {
      events.push({ type: 'refused', player: action.player, reason: phase === 'running' ? 'not-next' : 'phase' });
      continue;
    }
    total += 1;
    events.push({ type: 'counted', player: action.player, total });
    if (total === goal) phase = 'over';
  }
  const present = players.filter((player) => player.present);
  if (phase === 'ready' && present.length > 0 && present.every(({ ready }) => ready)) phase = 'running';
  if (state.phase === 'running' && phase === 'over') for (const player of players) player.ready = false;
  return { state: { tick: state.tick + 1, phase, total, players }, events };
}

function startMatch(
  seats: number,
  goal: number,
  onTick: (actions: readonly MatchAction<CountingGame>[]) => void,
): HostedMatch<CountingGame> {
  const players = Array.from({ length: seats }, () => ({ present: false, ready: false, headHeight: null }));
  const rules = {
    tickSeconds,
    start: (): CountingState => ({ tick: 0, phase: 'ready', total: 0, players }),
    step: (state: CountingState, actions: readonly MatchAction<CountingGame>[]) => stepped(goal, state, actions),
  };
  return createMatch(rules, rules.start(), { onTick });
}

/** The counting game for a Room with so many seats; `goal`: ends a round. */
export const countingPolicy = (seats: number, goal = 3): MatchPolicy<CountingGame> => ({
  kind: countingKind,
  seats,
  tickSeconds,
  start: (onTick) => startMatch(seats, goal, onTick),
  next: (_state, onTick) => startMatch(seats, goal, onTick),
  snapshot: ({ total }) => ({ total }),
  readAction(value) {
    const { type, to } = (value ?? {}) as { type?: unknown; to?: unknown };
    return type === 'count' && Number.isInteger(to) ? { type, to: to as number } : null;
  },
  refusalInPause: (player) => ({ type: 'refused', player, reason: 'paused' }),
  refusalOf: (event) => (event.type === 'refused' ? event : null),
  arenaFromFloor: (seat) => ({ position: vec3(0, seat, 0), orientation: identity }),
});

const noTerms = v.strictObject({});

/** The counting game for a server. */
export const countingRoomKind = (seats: number): RoomKind => ({
  openTerms: noTerms,
  assignedTerms: noTerms,
  createPolicy: () => countingPolicy(seats),
});

const counted = v.strictObject({ type: v.literal('counted'), player: v.number(), total: v.number() });
const refused = v.strictObject({ type: v.literal('refused'), player: v.number(), reason: v.string() });

/**
 * The counting game as a client of its Room follows it: a client knows the total alone, and predicts its own next
 * number.
 */
export const countingClientPolicy: ClientPolicy<CountingGame> = {
  kind: countingKind,
  readMessage: roomMessageReader<CountingGame>(
    countingKind,
    v.strictObject({ total: v.number() }),
    v.union([counted, refused]),
  ),
  unpack: ({ total }) => ({ tick: 0, phase: 'running', total, players: [] }),
  follow: (state, event) => (event.type === 'counted' ? { ...state, total: event.total } : state),
  at: (state, matchTime) => ({ ...state, tick: Math.floor(matchTime / tickSeconds) }),
  predict: (state, _seat, { to }) => (to === state.total + 1 ? { ...state, total: to } : state),
  answers: (event, seat, { to }) => event.player === seat && (event.type === 'refused' || event.total === to),
  arenaFromFloor: (seat) => ({ position: vec3(0, seat, 0), orientation: identity }),
};
