import {
  type Buttons,
  type Calibration,
  chestSpaceBody,
  type HapticPulse,
  type Pointer,
  type TrackingFrame,
} from 'threepoint/core';
import { add, subtract, type TrackedPose, type Vec3, zero } from 'threepoint/math';
import { createMatch, type Match, type SimulatedInput } from 'threepoint-games';
import {
  type ArcheryAction,
  type ArcheryEvent,
  ArcheryGestures,
  type ArcheryState,
  aimOf,
  archeryRules,
  type BowCue,
  type BowView,
  createSimulatedArcher,
  createSteeredArcher,
  delayed,
  fullScore,
  isArmed,
  matchTime,
  type SimulatedArcher,
  type SteeredArcher,
  secondsLeft,
} from 'threepoint-games/archery';
import type { ActivitySettings } from '../activity/activity-context';

/** The player's choices, read in every frame. */
type ArcherySettings = Pick<ActivitySettings, 'bowSide' | 'oneHanded' | 'everyHitCounts' | 'startSignal' | 'seconds'>;

/** The result of one frame of play, for view, sound and haptics. */
export interface ArcheryFrame {
  readonly state: ArcheryState;
  /** Seconds of the match. They continue after its end, for the effects of the last arrow. */
  readonly time: number;
  readonly bow: BowView | null;
  readonly events: readonly ArcheryEvent[];
  readonly cues: readonly BowCue[];
  readonly haptics: readonly HapticPulse[];
}

/** Returns the state of a round as plain data, for tests and tools. */
export const probeOf = ({ state, bow }: ArcheryFrame) => ({
  name: 'archery' as const,
  phase: state.phase,
  end: state.end,
  score: state.score,
  arrowsLeft: state.arrowsLeft,
  secondsLeft: secondsLeft(state),
  inZone: state.inZone,
  bowSide: bow?.bowSide ?? null,
  stage: bow?.stage ?? null,
  draw: bow?.draw ?? 0,
  /** The middle of the string, floor frame [m]; null: no hand holds the bow. */
  nockPoint: bow && ([bow.nockPoint.x, bow.nockPoint.y, bow.nockPoint.z] as const),
  hits: state.arrows.map(({ landing }) => landing?.target ?? null),
});

export type ArcheryProbe = ReturnType<typeof probeOf>;

/** Returns the figures of the scoreboard. */
export function roundOf({ state }: ArcheryFrame) {
  return {
    score: state.score,
    of: fullScore(state),
    arrowsLeft: state.arrowsLeft,
    secondsLeft: secondsLeft(state),
    over: state.phase === 'over',
  };
}

/** The owner of what a pointer holds here, and the time in which a gaze at a target nocks, draws and shoots [s]. */
const owner = 'archery';
const dwellSeconds = 2;

/** Returns the input with its hands at this place. */
function movedTo(place: Vec3, { frame, buttons }: SimulatedInput): SimulatedInput {
  const moved = (hand: TrackedPose | null) => hand && { ...hand, position: add(hand.position, place) };
  return { frame: { ...frame, leftHand: moved(frame.leftHand), rightHand: moved(frame.rightHand) }, buttons };
}

/** A round and its player, without the view. */
export class ArcheryPlay {
  newest: ArcheryFrame | null = null;
  readonly #settings: () => ArcherySettings;
  readonly #seed: () => number;
  readonly #gestures: ArcheryGestures;
  #match!: Match<ArcheryState, ArcheryAction, ArcheryEvent>;
  #archer!: SimulatedArcher;
  #steered!: SteeredArcher;
  /** The time of the newest frame on the page's clock [s]. */
  #followedAt = Number.NaN;
  /** The target at which a pointer drew last; null: none, or the arrow was put back. */
  #drawnAt: number | null = null;
  /** The point that a pointer aimed at last, arena frame. */
  #aimedAt: Vec3 | null = null;
  #signalled = false;
  #handsReplaced = false;

  /** `seed` gives each round its own layout. */
  constructor(calibration: Calibration, settings: () => ArcherySettings, seed: () => number) {
    this.#settings = settings;
    this.#seed = seed;
    this.#gestures = new ArcheryGestures(() => ({
      bowSide: settings().bowSide,
      oneHanded: settings().oneHanded,
      armed: isArmed(this.#match.state),
    }));
    this.restart(calibration);
  }

  /**
   * The point that a pointer aims at, arena frame, and the draw of its archer at the anchor [m]; null: none has aimed
   * yet, or no arrow is left.
   */
  get aim(): { readonly point: Vec3; readonly fullDraw: number } | null {
    const point = this.#aimedAt;
    return point && isArmed(this.#match.state) ? { point, fullDraw: this.#steered.fullDraw } : null;
  }

  get targets(): ArcheryState['targets'] {
    return this.#match.state.targets;
  }

  /** Advances the round by a tracked frame and its buttons. */
  follow(frame: TrackingFrame, buttons: Buttons): ArcheryFrame {
    const followed = this.#handsReplaced ? { ...frame, suspended: true as const } : frame;
    const { bow, actions, cues, haptics } = this.#gestures.follow(followed, buttons);
    this.#handsReplaced = false;
    const signals: readonly ArcheryAction[] = this.#signalled ? [{ type: 'start' }] : [];
    this.#signalled = false;
    const match = this.#match;
    const events = match.advance(frame.time, [...signals, ...actions]);
    const { state } = match;
    const before = state.phase === 'over' ? this.newest : null;
    const since = Math.max(0, frame.time - this.#followedAt);
    const time = before ? before.time + since : matchTime(state) + match.lead;
    this.#followedAt = frame.time;
    this.newest = { state, time: Math.max(0, time), bow, events, cues, haptics };
    return this.newest;
  }

  /** Returns the input of the simulated archer at a time [s]. */
  act(time: number): SimulatedInput {
    return this.#archer.follow(time, this.#match.state);
  }

  /**
   * Returns the input of an archer who aims along a pointer (arena frame) and draws while it is held. `place`: where
   * the archer stands, from the middle of the zone [m].
   */
  steer(time: number, pointer: Pointer, place: Vec3 = zero): SimulatedInput {
    const { state } = this.#match;
    const aim = aimOf(pointer.origin, pointer.direction, state.targets);
    const pressed = pointer.isHeldFor(owner);
    const { cancelled } = pointer;
    if (pressed) this.#drawnAt = aim.target;
    else if (cancelled) this.#drawnAt = null;
    // Until the hands are back from a shot, a gaze can rest on no other target: its hold would not be heeded.
    const heeded = !this.#steered.isRecovering || aim.target === this.#drawnAt;
    if (aim.target !== null && isArmed(state) && heeded) {
      pointer.pointAt({ distance: aim.distance, owner, id: `target ${aim.target}`, dwellSeconds });
    }
    // A gaze looks around, also at the menu, which a bow that followed it would cover.
    if (pointer.releases || aim.target !== null) this.#aimedAt = aim.point;
    // The simulated archer stands in the middle of the zone: what it sees and does moves to the place.
    const target = subtract(this.#aimedAt ?? aim.point, place);
    return movedTo(place, this.#steered.follow(time, { target, pressed, cancelled }));
  }

  /**
   * Starts another round for a person with this calibration, whose eyes are at this height now [m], standing or seated.
   */
  restart(person: Calibration, eyeHeight = person.eyeHeight): void {
    const { bowSide, everyHitCounts, startSignal, seconds } = this.#settings();
    const options = {
      eyeHeight,
      everyHitCounts,
      startedBy: startSignal ? ('signal' as const) : ('arrow' as const),
      ...(seconds && { seconds }),
    };
    this.#match = createMatch(archeryRules, archeryRules.start(['archer'], this.#seed(), options), { delayed });
    const body = { bowSide, eyeHeight, armLength: chestSpaceBody(person).arm };
    this.#archer = createSimulatedArcher(body);
    this.#steered = createSteeredArcher(body);
    this.newest = null;
    this.#signalled = false;
    // An arrow that was drawn before is no arrow of this round.
    this.#handsReplaced = true;
  }

  /** Announces that the floor frame jumps before the next frame. */
  discontinuity(): void {
    this.#gestures.discontinuity();
  }

  /** Announces that other hands hold the bow from the next frame on. They do not release a drawn arrow. */
  replaceHands(): void {
    this.#handsReplaced = true;
  }

  /** Starts the clock of a waiting round with the next frame, instead of with the first arrow. */
  signal(): void {
    this.#signalled = true;
  }
}
