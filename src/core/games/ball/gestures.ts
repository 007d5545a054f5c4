import { type Transform, transformPoint, transformPose } from '../../math/pose';
import { distance, type Vec3 } from '../../math/vec3';
import type { TrackedPose, TrackingFrame } from '../../tracking/tracking-frame';
import {
  allReleased,
  type Button,
  type Buttons,
  createButtonPresses,
  pressureOf,
  releasedBelow,
} from '../button-presses';
import { fistOf, type Side } from '../fist';
import type { BallAction, BallDeed, BallEvent, BallState } from './ball-state';
import { createHandSpeed } from './hand-speed';
import { slowestThrow } from './rules';
import { rackPosition } from './stations';

/** Who plays and how the match stands; asked for in every frame. */
export interface BallGestureSettings {
  /** The player's index. */
  readonly player: number;
  /** As far as it is known here. */
  readonly state: BallState;
  readonly arenaFromFloor: Transform<'arena', 'floor'>;
  /** Seconds of the match minus the seconds of the frames. */
  readonly matchAhead: number;
}

/** A buzz for one hand. */
export interface BallPulse {
  readonly side: Side;
  /** 0 to 1. */
  readonly strength: number;
  readonly seconds: number;
}

/** Something to hear or see in a caption. slipped: the ball was somebody else's. */
export interface BallCue {
  readonly type: 'near' | 'grabbed' | 'thrown' | 'dropped' | 'slipped';
  readonly side: Side;
  readonly ball: number;
}

/** What one frame of hands and buttons means. */
export interface BallGestureFrame {
  /** Arena frame; the pose first. */
  readonly actions: readonly BallAction[];
  readonly haptics: readonly BallPulse[];
  readonly cues: readonly BallCue[];
  /** The ball in each hand, by what the hand did; null: none. */
  readonly held: Readonly<Record<Side, number | null>>;
  /** The ball that a press would take; null: none. */
  readonly near: Readonly<Record<Side, number | null>>;
}

/** Turns tracked hands and their buttons into what ball players do. */
export interface BallGestures {
  /** Frames in the order of their time; irregular ones are fine. */
  follow(frame: TrackingFrame, buttons: Buttons): BallGestureFrame;
  /** What the match said: a ball that was refused is in no hand. */
  hear(events: readonly BallEvent[]): void;
  /** The number of the last deed; a player who returns goes on from there. */
  readonly sequence: number;
}

/** A press takes a ball from this far from the fist [m]. */
export const takeReach = 0.2;
/** A hand may be lost for this long [s] with a ball in it; then the ball goes back to the rack. */
export const holdSeconds = 0.5;
/** A pause of this length [s] throws nothing. */
const longestPause = 0.3;

interface Holding {
  readonly ball: number;
  readonly button: Button;
  readonly sequence: number;
  /** Time of the first frame that missed the hand [s]; null: seen. */
  lostAt: number | null;
  /** An opened pinch counts with the next frame that sees the hand: fingers also seem to open when a camera loses them. */
  opened: { readonly time: number; readonly position: Vec3; readonly velocity: Vec3 } | null;
}

const sides = ['left', 'right'] as const;

const seenHand = (hand: TrackedPose | null): TrackedPose | null => (hand?.tracking === 'tracked' ? hand : null);

/** One per player; deeds are numbered from the one after `sequence`. */
export function createBallGestures(settings: () => BallGestureSettings, firstSequence = 0): BallGestures {
  const presses = createButtonPresses();
  const speeds = { left: createHandSpeed(), right: createHandSpeed() };
  const holding: Record<Side, Holding | null> = { left: null, right: null };
  const wasNear: Record<Side, number | null> = { left: null, right: null };
  /** The newest throw of each hand, until it is known to be refused: then the ball is still in that hand. */
  const thrown: Record<Side, { readonly sequence: number; readonly ball: number } | null> = { left: null, right: null };
  const unthrown = new Set<Side>();
  let slipped: BallCue[] = [];
  let sequence = firstSequence;
  let lastTime: number | null = null;

  const inHand = (side: Side) => holding[side]?.ball ?? null;

  /** Another thing is before the page: what is held is held until the hands come back. */
  function wait(frame: TrackingFrame): BallGestureFrame {
    const { player, arenaFromFloor, matchAhead } = settings();
    lastTime = frame.time;
    for (const side of sides) {
      presses.follow(side, allReleased, false);
      speeds[side].reset();
      wasNear[side] = null;
      const held = holding[side];
      if (!held) continue;
      held.lostAt = frame.time;
      held.opened = null;
    }
    const head = transformPoint(arenaFromFloor, frame.head.position);
    return {
      actions: [{ type: 'pose', player, at: frame.time + matchAhead, head, left: null, right: null }],
      haptics: [],
      cues: [],
      held: { left: inHand('left'), right: inHand('right') },
      near: { ...wasNear },
    };
  }

  function follow(frame: TrackingFrame, buttons: Buttons): BallGestureFrame {
    if (frame.suspended) return wait(frame);
    const { player, state, arenaFromFloor, matchAhead } = settings();
    const cues = slipped;
    slipped = [];
    const haptics: BallPulse[] = [];
    const actions: BallAction[] = [];
    const paused = lastTime !== null && frame.time - lastTime > longestPause;
    lastTime = frame.time;
    const hands = { left: seenHand(frame.leftHand), right: seenHand(frame.rightHand) };
    const inArena = (hand: TrackedPose | null) => hand && transformPose(arenaFromFloor, hand);
    actions.push({
      type: 'pose',
      player,
      at: frame.time + matchAhead,
      head: transformPoint(arenaFromFloor, frame.head.position),
      left: inArena(hands.left),
      right: inArena(hands.right),
    });
    const act = (deed: BallDeed) => actions.push({ ...deed, player });
    const number = (): number => {
      sequence += 1;
      return sequence;
    };
    const thrower = state.players[player]?.role === 'thrower';
    const playing = thrower && state.phase === 'running';

    for (const side of unthrown) act({ type: 'drop', sequence: number(), side });
    unthrown.clear();
    for (const side of sides) {
      const hand = hands[side];
      const speed = speeds[side];
      const pressed = presses.follow(side, buttons[side] ?? allReleased, hand !== null);
      if (!hand || paused) speed.reset();
      const fist = hand && transformPoint(arenaFromFloor, fistOf(hand));
      if (fist) speed.follow(frame.time, fist);
      const held = holding[side];
      if (held) {
        wasNear[side] = null;
        if (!playing || paused || presses.changedKind(side)) drop(side, held);
        else carry(side, held, fist);
      } else if (playing && fist) {
        take(side, fist, pressed[0]);
      } else {
        wasNear[side] = null;
      }
    }

    return {
      actions,
      haptics,
      cues,
      held: { left: inHand('left'), right: inHand('right') },
      near: { ...wasNear },
    };

    function drop(side: Side, { ball }: Holding): void {
      holding[side] = null;
      act({ type: 'drop', sequence: number(), side });
      cues.push({ type: 'dropped', side, ball });
    }

    function take(side: Side, fist: Vec3, button: Button | undefined): void {
      const ball = nearestBall(state, fist, holding);
      if (ball !== null && ball !== wasNear[side] && !button) {
        cues.push({ type: 'near', side, ball });
        haptics.push({ side, strength: 0.15, seconds: 0.02 });
      }
      wasNear[side] = ball;
      if (ball === null || !button) return;
      const grab = number();
      holding[side] = { ball, button, sequence: grab, lostAt: null, opened: null };
      wasNear[side] = null;
      act({ type: 'grab', sequence: grab, side, ball });
      cues.push({ type: 'grabbed', side, ball });
      haptics.push({ side, strength: 0.5, seconds: 0.03 });
    }

    function carry(side: Side, held: Holding, fist: Vec3 | null): void {
      const value = pressureOf(buttons[side], held.button);
      if (!fist) {
        // The button of a hand that nobody sees says nothing: many devices let go of it when they lose the hand.
        held.opened = null;
        held.lostAt ??= frame.time;
        if (frame.time - held.lostAt >= holdSeconds) drop(side, held);
        return;
      }
      if (held.lostAt !== null) {
        held.lostAt = null;
        if (value < releasedBelow) drop(side, held);
        return;
      }
      if (value >= releasedBelow) {
        held.opened = null;
        return;
      }
      const now = { time: frame.time, position: fist, velocity: speeds[side].velocity() };
      if (held.button === 'pinch' && !held.opened) held.opened = now;
      else letGo(side, held, held.opened ?? now);
    }

    function letGo(
      side: Side,
      held: Holding,
      { time, position, velocity }: { readonly time: number; readonly position: Vec3; readonly velocity: Vec3 },
    ): void {
      const speed = distance(velocity, { x: 0, y: 0, z: 0 });
      if (speed < slowestThrow) {
        drop(side, held);
        return;
      }
      holding[side] = null;
      const sequence = number();
      thrown[side] = { sequence, ball: held.ball };
      act({ type: 'throw', sequence, side, ball: held.ball, at: time + matchAhead, position, velocity });
      cues.push({ type: 'thrown', side, ball: held.ball });
      haptics.push({ side, strength: Math.min(1, 0.3 + speed / 15), seconds: 0.05 });
    }
  }

  return {
    follow,
    hear(events) {
      const { player } = settings();
      for (const event of events) {
        for (const side of sides) {
          const throwing = thrown[side];
          if (event.type === 'refused' && event.player === player && event.sequence === throwing?.sequence) {
            thrown[side] = null;
            if (event.reason !== 'seen-before') {
              unthrown.add(side);
              slipped.push({ type: 'slipped', side, ball: throwing.ball });
            }
          }
          const held = holding[side];
          if (!held || !('player' in event) || event.player !== player) continue;
          const refused =
            event.type === 'refused' && event.sequence === held.sequence && event.reason !== 'seen-before';
          const returned = event.type === 'returned' && event.ball === held.ball;
          if (!refused && !returned) continue;
          holding[side] = null;
          slipped.push({ type: 'slipped', side, ball: held.ball });
        }
      }
    },
    get sequence() {
      return sequence;
    },
  };
}

/** The ball in a rack that a fist would take, unless the other hand has just taken it. */
function nearestBall(state: BallState, fist: Vec3, holding: Readonly<Record<Side, Holding | null>>): number | null {
  let nearest: number | null = null;
  let least = takeReach;
  state.balls.forEach((place, ball) => {
    if (place.on !== 'rack' || holding.left?.ball === ball || holding.right?.ball === ball) return;
    const far = distance(fist, rackPosition(ball, state.options.balls));
    if (far > least) return;
    nearest = ball;
    least = far;
  });
  return nearest;
}
