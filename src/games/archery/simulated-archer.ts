import { addScaled, clamp, subtract } from 'threepoint/math';
import { minimumJerk, yawOf } from '../simulated-body';
import type { SimulatedInput } from '../simulated-input';
import { type ArcherBody, ArcherPostures, mixPostures, type Posture } from './archer-postures';
import type { ArcheryState, Target } from './archery-state';

/** A movement to a posture, with its pressure on the button; at rest at both ends. */
interface Movement {
  readonly to: Posture;
  readonly seconds: number;
  readonly pressure: number;
  /** How far the string hand swings outward on its way [m]. */
  readonly arc?: number;
  /** Whether the movement lasts until no arrow flies. */
  readonly waits?: boolean;
}

/**
 * Returns the next target: the nearest one that has not scored; if all have and every hit counts, the one worth most.
 */
function nextTarget(state: ArcheryState): Target | null {
  if (state.phase === 'over' || state.arrowsLeft === 0) return null;
  const scored = (index: number) => state.arrows.some(({ landing }) => landing?.target === index);
  const open = state.targets.filter((_, index) => !scored(index)).sort((a, b) => a.distance - b.distance);
  const best = [...state.targets].sort((a, b) => b.points - a.points);
  return open[0] ?? (state.options.everyHitCounts ? (best[0] ?? null) : null);
}

/**
 * The built-in archer, which produces hands and buttons for a whole round. Creates an archer that stands at the centre
 * of the zone, shoots at every target, nearest first, and then rests. Deterministic.
 */
export function createSimulatedArcher(body: ArcherBody) {
  const postures = new ArcherPostures(body);
  const { eyes } = postures;

  /** Returns the movements of a shot: take an arrow, nock, raise, draw, aim, release, follow through. */
  function shotAt(target: Target): Movement[] {
    const yaw = yawOf(subtract(target.centre, eyes));
    const full = postures.drawn(target.centre);
    const taking = postures.ready(yaw);
    const nocking: Posture = { ...taking, onString: 1 };
    const raised: Posture = {
      ...full,
      hold: {
        ...full.hold,
        arrowRest: addScaled(full.hold.arrowRest, full.hold.direction, -0.3 * full.hold.draw),
        draw: 0.12 * full.hold.draw,
      },
      trunkYaw: (taking.trunkYaw + full.trunkYaw) / 2,
    };
    const after = postures.followedThrough(full);
    return [
      { to: taking, seconds: 0.9, pressure: 0, arc: 0.04 },
      { to: nocking, seconds: 0.7, pressure: 0, arc: 0.1 },
      { to: nocking, seconds: 0.2, pressure: 1 },
      { to: raised, seconds: 0.7, pressure: 1 },
      { to: full, seconds: 0.75, pressure: 1 },
      { to: full, seconds: 0.75, pressure: 1 },
      { to: full, seconds: 0.08, pressure: 0 },
      { to: after, seconds: 0.22, pressure: 0 },
      { to: after, seconds: 0.35, pressure: 0, waits: true },
    ];
  }

  let from: Posture = postures.resting(0);
  let fromPressure = 0;
  let began = 0;
  let plan: Movement[] = [];
  /** Whether the archer rests, or is about to. */
  let idle = true;

  /** Ends the movements that are over by `time` and plans the next. */
  function proceed(time: number, state: ArcheryState): void {
    for (;;) {
      const current = plan[0];
      if (!current) {
        const target = nextTarget(state);
        if (!target && idle) return;
        if (idle) began = time;
        idle = target === null;
        plan = target ? shotAt(target) : [{ to: postures.resting(0), seconds: 1.2, pressure: 0, arc: 0.04 }];
        continue;
      }
      if (time - began < current.seconds) return;
      if (current.waits && state.arrows.some(({ landing }) => landing === null)) return;
      from = current.to;
      fromPressure = current.pressure;
      // A wait ends with the frame that sees its end; other movements end exactly on time.
      began = current.waits ? time : began + current.seconds;
      plan = plan.slice(1);
      // The arrow leaves with the frame that shows the open hand; wait for it.
      if (plan[0]?.waits) return;
    }
  }

  return {
    /** Returns head, hands (floor frame) and buttons at `time` [s, not decreasing], for this state of the match. */
    follow(time: number, state: ArcheryState): SimulatedInput {
      proceed(time, state);
      const current = plan[0];
      const share = current ? minimumJerk(clamp((time - began) / current.seconds, 0, 1)) : 0;
      const now = current ? mixPostures(from, current.to, share) : from;
      const pressure = current ? fromPressure + (current.pressure - fromPressure) * share : fromPressure;

      const swing = (current?.arc ?? 0) * Math.sin(Math.PI * share) ** 2;
      return postures.inputFor(now, time, pressure, swing);
    },
  };
}

export type SimulatedArcher = ReturnType<typeof createSimulatedArcher>;
