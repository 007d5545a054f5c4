import {
  allReleased,
  type Button,
  ButtonPresses,
  type Buttons,
  type HapticPulse,
  type Mutable,
  playingHand,
  pressureOf,
  releasedBelow,
  type TrackingFrame,
} from 'threepoint/core';
import {
  copyVec3,
  distance,
  length,
  type MutablePose,
  type MutableVec3,
  makePose,
  makeTransform,
  type Side,
  sides,
  type TrackedPose,
  type Transform,
  transformPoint,
  transformPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { ballInPalm, fistOf } from '../fist';
import { slowestThrow } from './action-rules';
import type { BallAction, BallEvent, BallInput, BallState } from './ball-state';
import { ballRadius } from './flight';
import { HandVelocity } from './hand-velocity';
import { ballInHand } from './state-selectors';
import { rackPosition } from './stations';

/** The player and the match, which the gestures read in every frame. */
interface BallGestureSettings {
  /** The player's index. */
  readonly player: number;
  /** The state of the match, with predictions. */
  readonly state: BallState;
  readonly arenaFromFloor: Transform<'arena', 'floor'>;
  /** Seconds of the match minus the seconds of the frames. */
  readonly matchAhead: number;
}

/** A cue for sounds and captions. slipped: the match has the ball elsewhere. */
export interface BallCue {
  readonly type: 'near' | 'grabbed' | 'thrown' | 'dropped' | 'slipped';
  readonly side: Side;
  readonly ball: number;
}

/** The gestures of one frame. The pose among its actions, `held` and `near` are the same objects in every frame. */
export interface BallGestureFrame {
  /** Inputs of the rules, arena frame; the pose is the first. */
  readonly actions: readonly BallInput[];
  readonly haptics: readonly HapticPulse[];
  readonly cues: readonly BallCue[];
  /** The ball in each hand, by the hand's own actions; null: none. */
  readonly held: Readonly<Record<Side, number | null>>;
  /** The ball that a press would take; null: none. */
  readonly near: Readonly<Record<Side, number | null>>;
}

/** A press takes a ball within this distance of the fist [m]. */
const takeReach = 0.2;
/** After this long without its hand [s] a held ball returns to the rack. */
export const holdSeconds = 0.5;
/** A pause of this length [s] throws nothing. */
const longestPause = 0.3;

/** The state of a hand when it opened, arena frame. */
interface Opened {
  readonly time: number;
  readonly position: Vec3;
  readonly velocity: Vec3;
}

interface Holding {
  readonly ball: number;
  readonly button: Button;
  readonly sequence: number;
  /** Time of the first frame without the hand [s]; null: tracked. */
  lostAt: number | null;
  /**
   * An opened pinch. It counts in the next frame with a tracked hand, because fingers also seem to open when tracking
   * is lost.
   */
  opened: Opened | null;
}

interface HandState {
  readonly speed: HandVelocity;
  holding: Holding | null;
  /** The newest throw, until it is refused: then the match still has the ball in the hand. */
  thrown: { readonly sequence: number; readonly ball: number } | null;
  /**
   * Whether the match has a ball in this hand that the hand does not hold, as after a refused throw; it is returned.
   */
  unthrown: boolean;
  /** The centre of the fist in this frame, arena frame. */
  readonly fist: MutableVec3;
  /** The centre of a ball in the palm, arena frame, from which it is thrown. */
  readonly palm: MutableVec3;
  /** The wrist, arena frame. */
  readonly pose: MutablePose<'arena'>;
}

const makeHandState = (): HandState => ({
  speed: new HandVelocity(),
  holding: null,
  thrown: null,
  unthrown: false,
  fist: vec3(0, 0, 0),
  palm: vec3(0, 0, 0),
  pose: makePose<'arena'>(),
});

type PoseAction = Extract<BallInput, { type: 'pose' }>;

/** Turns the tracked hands of one player and their buttons into actions of the ball game, numbered from 1. */
export class BallGestures {
  /** The number of the last action. */
  private sequence = 0;
  /** Whether the hands must be compared with a new state of the match. */
  private stale = true;
  /** Since when a ball may be in a hand only by the match's state [s]; null: none is. */
  private strayedAt: number | null = null;
  private readonly presses = new ButtonPresses();
  private readonly hands: Readonly<Record<Side, HandState>> = { left: makeHandState(), right: makeHandState() };
  private readonly near: Record<Side, number | null> = { left: null, right: null };
  private readonly held: Record<Side, number | null> = { left: null, right: null };
  private slipped: BallCue[] = [];
  private lastTime = Number.NaN;
  private readonly head = vec3(0, 0, 0);
  private readonly pose: Mutable<PoseAction>;
  // The frame that is being processed.
  private now: BallGestureSettings;
  private time = 0;
  private actions: BallInput[] = [];
  private haptics: HapticPulse[] = [];
  private cues: BallCue[] = [];

  constructor(private readonly settings: () => BallGestureSettings) {
    this.now = { player: 0, state: null as never, arenaFromFloor: makeTransform<'arena', 'floor'>(), matchAhead: 0 };
    this.pose = { type: 'pose', player: 0, at: 0, head: this.head, left: null, right: null };
  }

  /** Returns the number of another action of the same player. */
  nextSequence(): number {
    this.sequence += 1;
    return this.sequence;
  }

  /** Processes a frame; times must rise, at any interval. */
  follow(frame: TrackingFrame, buttons: Buttons): BallGestureFrame {
    this.begin(frame);
    if (frame.suspended) return this.wait();
    const { player, state, arenaFromFloor } = this.now;
    const paused = frame.time - this.lastTime > longestPause;
    this.lastTime = frame.time;
    const left = playingHand(frame.leftHand, buttons.left);
    const right = playingHand(frame.rightHand, buttons.right);
    this.pose.left = left && transformPose(arenaFromFloor, left, this.hands.left.pose);
    this.pose.right = right && transformPose(arenaFromFloor, right, this.hands.right.pose);
    const playing = state.players[player]?.role === 'thrower' && state.phase === 'running';
    if (this.stale) this.compare(state, player);
    this.findStrays(state, player);
    for (const side of sides) {
      const hand = this.hands[side];
      if (hand.unthrown) this.act({ type: 'drop', sequence: this.nextSequence(), side });
      hand.unthrown = false;
    }
    this.followHand('left', left, buttons, playing, paused);
    this.followHand('right', right, buttons, playing, paused);
    return this.finish();
  }

  /** Processes events of the match: a refused ball leaves the hand. */
  onEvents(events: readonly BallEvent[]): void {
    if (events.length === 0) return;
    const { player } = this.settings();
    for (const event of events) for (const side of sides) this.onEvent(side, event, player);
  }

  /** Announces that the floor frame jumps: velocities start over. */
  discontinuity(): void {
    for (const side of sides) this.hands[side].speed.reset();
  }

  /**
   * Announces a new state of the match, which may lack actions of these hands. From the next frame on the hands release
   * balls that it has elsewhere, and return balls that only it has in them.
   */
  resume(): void {
    this.stale = true;
  }

  private begin(frame: TrackingFrame): void {
    this.now = this.settings();
    const { player, arenaFromFloor, matchAhead } = this.now;
    this.time = frame.time;
    this.pose.player = player;
    this.pose.at = frame.time + matchAhead;
    transformPoint(arenaFromFloor, frame.head.position, this.head);
    this.actions = [this.pose];
    this.haptics = [];
  }

  /** Removes from the hands what the match has elsewhere. */
  private compare(state: BallState, player: number): void {
    this.stale = false;
    this.strayedAt = this.time;
    for (const side of sides) {
      const hand = this.hands[side];
      if (!hand.holding || hand.holding.ball === ballInHand(state, player, side)) continue;
      this.slipped.push({ type: 'slipped', side, ball: hand.holding.ball });
      hand.holding = null;
    }
  }

  /**
   * Marks balls for return that only the match has in a hand for `holdSeconds`; by then the seat's previous player has
   * lost theirs.
   */
  private findStrays(state: BallState, player: number): void {
    if (this.strayedAt === null || this.time - this.strayedAt < holdSeconds) return;
    this.strayedAt = null;
    for (const side of sides) {
      const hand = this.hands[side];
      if (!hand.holding && ballInHand(state, player, side) >= 0) hand.unthrown = true;
    }
  }

  /** Handles a suspended session: held balls stay in the hands. */
  private wait(): BallGestureFrame {
    this.lastTime = this.time;
    this.pose.left = null;
    this.pose.right = null;
    this.cues = [];
    for (const side of sides) {
      const { speed, holding } = this.hands[side];
      this.presses.follow(side, allReleased, false);
      speed.reset();
      this.near[side] = null;
      if (!holding) continue;
      holding.lostAt = this.time;
      holding.opened = null;
    }
    return this.result();
  }

  private finish(): BallGestureFrame {
    this.cues = this.slipped.length > 0 ? [...this.slipped, ...this.cues] : this.cues;
    this.slipped = [];
    return this.result();
  }

  private result(): BallGestureFrame {
    const { actions, haptics, cues, held, near, hands } = this;
    held.left = hands.left.holding?.ball ?? null;
    held.right = hands.right.holding?.ball ?? null;
    this.cues = [];
    return { actions, haptics, cues, held, near };
  }

  private act(action: BallAction): void {
    this.actions.push({ ...action, player: this.now.player });
  }

  private followHand(side: Side, wrist: TrackedPose | null, buttons: Buttons, playing: boolean, paused: boolean): void {
    const { speed, fist, palm, holding } = this.hands[side];
    const pressed = this.presses.follow(side, buttons[side] ?? allReleased, wrist !== null);
    if (!wrist || paused) speed.reset();
    if (wrist) {
      transformPoint(this.now.arenaFromFloor, fistOf(wrist, fist), fist);
      transformPoint(this.now.arenaFromFloor, ballInPalm(wrist, ballRadius, palm), palm);
      speed.follow(this.time, copyVec3(fist));
    }
    if (holding) {
      this.near[side] = null;
      if (!playing || paused || this.presses.changedKind(side)) this.drop(side, holding);
      else this.carry(side, holding, wrist !== null, pressureOf(buttons[side], holding.button));
    } else if (playing && wrist) this.take(side, pressed[0]);
    else this.near[side] = null;
  }

  private drop(side: Side, { ball }: Holding): void {
    this.hands[side].holding = null;
    this.act({ type: 'drop', sequence: this.nextSequence(), side });
    this.cues.push({ type: 'dropped', side, ball });
  }

  private take(side: Side, button: Button | undefined): void {
    const { left, right } = this.hands;
    const ball = nearestBall(this.now.state, this.hands[side].fist, left.holding, right.holding);
    if (ball !== null && ball !== this.near[side] && !button) {
      this.cues.push({ type: 'near', side, ball });
      this.haptics.push({ side, strength: 0.15, seconds: 0.02 });
    }
    this.near[side] = ball;
    if (ball === null || !button) return;
    const sequence = this.nextSequence();
    this.hands[side].holding = { ball, button, sequence, lostAt: null, opened: null };
    this.near[side] = null;
    this.act({ type: 'grab', sequence, side, ball });
    this.cues.push({ type: 'grabbed', side, ball });
    this.haptics.push({ side, strength: 0.5, seconds: 0.03 });
  }

  private carry(side: Side, held: Holding, seen: boolean, pressure: number): void {
    if (!seen) {
      // The button of a lost hand is ignored: many devices release it when they lose the hand.
      held.opened = null;
      held.lostAt ??= this.time;
      if (this.time - held.lostAt >= holdSeconds) this.drop(side, held);
      return;
    }
    if (held.lostAt !== null) {
      held.lostAt = null;
      if (pressure < releasedBelow) this.drop(side, held);
      return;
    }
    if (pressure >= releasedBelow) {
      held.opened = null;
      return;
    }
    const { palm, speed } = this.hands[side];
    const now: Opened = { time: this.time, position: copyVec3(palm), velocity: speed.velocity() };
    if (held.button === 'pinch' && !held.opened) held.opened = now;
    else this.release(side, held, held.opened ?? now);
  }

  private release(side: Side, held: Holding, { time, position, velocity }: Opened): void {
    const { ball } = held;
    const speed = length(velocity);
    if (speed < slowestThrow) {
      this.drop(side, held);
      return;
    }
    const hand = this.hands[side];
    const sequence = this.nextSequence();
    hand.holding = null;
    hand.thrown = { sequence, ball };
    this.act({ type: 'throw', sequence, side, ball, at: time + this.now.matchAhead, position, velocity });
    this.cues.push({ type: 'thrown', side, ball });
    this.haptics.push({ side, strength: Math.min(1, 0.3 + speed / 15), seconds: 0.05 });
  }

  private onEvent(side: Side, event: BallEvent, player: number): void {
    const hand = this.hands[side];
    const { thrown, holding } = hand;
    if (event.type === 'refused' && event.player === player && event.sequence === thrown?.sequence) {
      hand.thrown = null;
      if (event.reason !== 'seen-before') {
        hand.unthrown = true;
        this.slipped.push({ type: 'slipped', side, ball: thrown.ball });
      }
    }
    if (!holding || !('player' in event) || event.player !== player) return;
    const refused = event.type === 'refused' && event.sequence === holding.sequence && event.reason !== 'seen-before';
    const returned = event.type === 'returned' && event.ball === holding.ball;
    if (!refused && !returned) return;
    hand.holding = null;
    this.slipped.push({ type: 'slipped', side, ball: holding.ball });
  }
}

/** Returns the ball in a rack that a fist would take, without those that a hand has just taken. */
function nearestBall(state: BallState, fist: Vec3, left: Holding | null, right: Holding | null): number | null {
  let nearest: number | null = null;
  let least = takeReach;
  for (let ball = 0; ball < state.balls.length; ball++) {
    if (state.balls[ball]!.on !== 'rack' || left?.ball === ball || right?.ball === ball) continue;
    const far = distance(fist, rackPosition(ball, state.options.balls, rack));
    if (far > least) continue;
    nearest = ball;
    least = far;
  }
  return nearest;
}

const rack = vec3(0, 0, 0);
