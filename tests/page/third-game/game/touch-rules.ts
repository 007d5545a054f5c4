import type { SeatAction } from 'threepoint/core';
import { distance, identity, type Transform, type Vec3, vec3 } from 'threepoint/math';
import { finiteWithin, integerWithin } from 'threepoint-rooms/room';
import * as v from 'valibot';

export interface TouchOptions {
  /** Touches that end a match, and its length [s]. */
  readonly goal: number;
  readonly seconds: number;
  /** A match waits for both players. */
  readonly everySeat: boolean;
}

const player = v.strictObject({
  present: v.boolean(),
  ready: v.boolean(),
  /** The lit target of this player, and the player's touches. */
  lit: integerWithin(0, 3),
  touched: integerWithin(0, 1000),
});

/** The schema of a match's state; a client receives it with every event. */
export const touchState = v.strictObject({
  tick: integerWithin(0, 1e9),
  phase: v.picklist(['ready', 'running', 'over']),
  startedAt: v.nullable(finiteWithin(1e7)),
  end: v.nullable(v.picklist(['time', 'all-touched'])),
  goal: integerWithin(1, 1000),
  seconds: finiteWithin(3600),
  everySeat: v.boolean(),
  players: v.array(player),
});
export type TouchState = v.InferOutput<typeof touchState>;

export const touchAction = v.strictObject({ type: v.literal('touch'), target: integerWithin(0, 3) });
export type TouchAction = v.InferOutput<typeof touchAction>;
export type TouchInput = SeatAction | (TouchAction & { readonly player: number });

export const touchEvent = v.strictObject({
  type: v.picklist(['changed', 'started', 'touched', 'refused', 'ended']),
  player: v.nullable(integerWithin(0, 1)),
  state: touchState,
});
export type TouchEvent = v.InferOutput<typeof touchEvent>;

/** A hand is at a target within this distance [m]. */
export const reach = 0.14;
const tickSeconds = 1 / 30;
const floors: readonly Transform<'arena', 'floor'>[] = [-0.7, 0.7].map((x) => ({
  position: vec3(x, 0, 0),
  orientation: identity,
}));

/** Returns the floor of a seat: the players stand 1.4 m apart, side by side. */
export const floorOf = (seat: number): Transform<'arena', 'floor'> => floors[seat] ?? floors[0]!;

/** Returns a target of a seat, arena frame [m]. */
export const targetOf = (seat: number, target: number): Vec3 =>
  vec3(floorOf(seat).position.x + (target % 2 === 0 ? -0.3 : 0.3), target < 2 ? 1.1 : 1.4, -0.4);

export const score = ({ players }: TouchState): number => players.reduce((sum, { touched }) => sum + touched, 0);

/** “Touch the lit targets”: each player has four targets, and a touch of the lit one lights another. */
export const touchRules = {
  tickSeconds,
  start: (_players: readonly string[], seed: number, options: Partial<TouchOptions> = {}): TouchState => ({
    ...{ tick: 0, phase: 'ready', startedAt: null, end: null, goal: 12, seconds: 30, everySeat: false, ...options },
    players: [0, 1].map((seat) => ({ present: false, ready: false, lit: (seed + seat) % 4, touched: 0 })),
  }),
  step(before: TouchState, actions: readonly TouchInput[]): { state: TouchState; events: readonly TouchEvent[] } {
    const state = { ...before, tick: before.tick + 1, players: before.players.map((each) => ({ ...each })) };
    const happened: Pick<TouchEvent, 'type' | 'player'>[] = [];
    for (const action of actions) {
      const of = 'player' in action ? state.players[action.player] : undefined;
      if (!of || !('player' in action)) continue;
      if (action.type === 'join' || action.type === 'leave') {
        Object.assign(of, { present: action.type === 'join', ready: false });
        happened.push({ type: 'changed', player: action.player });
      } else if (action.type === 'ready') {
        of.ready = action.ready;
        happened.push({ type: 'changed', player: action.player });
      } else if (action.type === 'touch') {
        const hits = state.phase === 'running' && score(state) < state.goal && action.target === of.lit;
        if (hits) Object.assign(of, { touched: of.touched + 1, lit: (of.lit + 1 + (state.tick % 3)) % 4 });
        happened.push({ type: hits ? 'touched' : 'refused', player: action.player });
      }
    }
    const present = state.players.filter((each) => each.present);
    const enough = present.length > (state.everySeat ? 1 : 0);
    if (state.phase === 'ready' && enough && present.every(({ ready }) => ready)) {
      Object.assign(state, { phase: 'running', startedAt: state.tick * tickSeconds });
      happened.push({ type: 'started', player: null });
    }
    const over = state.phase === 'running' && state.tick * tickSeconds >= (state.startedAt ?? 0) + state.seconds;
    if (state.phase === 'running' && (over || score(state) >= state.goal)) {
      Object.assign(state, { phase: 'over', end: over ? 'time' : 'all-touched' });
      for (const each of state.players) each.ready = false;
      happened.push({ type: 'ended', player: null });
    }
    return { state, events: happened.map((event) => ({ ...event, state })) };
  },
};

/** The gesture: returns the target that a hand of this player touches, arena frame; null: none. */
export function touchedTarget(seat: number, hands: readonly (Vec3 | null)[]): number | null {
  const touched = [0, 1, 2, 3].find((target) =>
    hands.some((hand) => hand && distance(hand, targetOf(seat, target)) < reach),
  );
  return touched ?? null;
}
