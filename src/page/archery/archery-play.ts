import type { Calibration } from 'threepoint/core/body/calibration';
import { chestSpaceBody } from 'threepoint/core/body/skeleton';
import type { Buttons } from 'threepoint/core/input/button-presses';
import type { Pointer } from 'threepoint/core/input/pointer';
import type { TrackedPose } from 'threepoint/core/math/pose';
import type { Side } from 'threepoint/core/math/side';
import { add, subtract, type Vec3, zero } from 'threepoint/core/math/vec3';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { aimOf } from 'threepoint-games/archery/aim-point';
import { type Archer, createArcher } from 'threepoint-games/archery/archer-motion';
import type { ArcheryAction, ArcheryEvent, ArcheryState, BowView } from 'threepoint-games/archery/archery-state';
import { ArcheryGestures, type BowCue, defaultArcheryGestureSettings } from 'threepoint-games/archery/gestures';
import { archeryRules, delayed, fullScore, isArmed, matchTime, secondsLeft } from 'threepoint-games/archery/rules';
import { createSteeredArcher, type SteeredArcher } from 'threepoint-games/archery/steered-archer';
import type { HapticPulse } from 'threepoint-games/haptic-pulse';
import { createMatch, type Match } from 'threepoint-games/match';
import type { PlayerInput } from 'threepoint-games/simulated-body';

/** The player's choices, read in every frame. */
export interface ArcherySettings {
  readonly bowSide: Side;
  readonly oneHanded: boolean;
  readonly everyHitCounts: boolean;
  /** Whether the round waits for its signal; absent: the first arrow starts it too. */
  readonly startSignal?: boolean;
  /** Until the bell; absent: as the game has it. */
  readonly seconds?: number;
}

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

/** A round and its player, without the view. */
export interface ArcheryPlay {
  /** The targets of this round. */
  readonly targets: ArcheryState['targets'];
  /** The newest frame; null before the first. */
  readonly newest: ArcheryFrame | null;
  /** The tracked frame and its buttons become play. */
  follow(frame: TrackingFrame, buttons: Buttons): ArcheryFrame;
  /** Returns the input of the simulated archer at a time [s]. */
  act(time: number): PlayerInput;
  /**
   * Returns the input of an archer who aims along a pointer (arena frame) and draws while it is held. `place`: where
   * the archer stands, from the middle of the zone [m].
   */
  steer(time: number, pointer: Pointer, place?: Vec3): PlayerInput;
  /**
   * Starts another round for a person with this calibration, whose eyes are at this height now [m], standing or seated.
   */
  restart(calibration: Calibration, eyeHeight?: number): void;
  /** The user's floor frame changes with the next frame. */
  discontinuity(): void;
  /** Other hands hold the bow from the next frame on. They do not release the arrow that the previous hands drew. */
  handedOver(): void;
  /** The start signal: the clock of a round that waits runs from the next frame on, not from the first arrow. */
  signal(): void;
}

/** What tools may know of a round. */
export interface ArcheryProbe {
  readonly name: 'archery';
  readonly phase: ArcheryState['phase'];
  readonly end: ArcheryState['end'];
  readonly score: number;
  readonly arrowsLeft: number;
  readonly secondsLeft: number;
  readonly inZone: boolean;
  readonly bowSide: Side | null;
  readonly stage: BowView['stage'] | null;
  readonly draw: number;
  /** The middle of the string, floor frame [m]; null: no hand holds the bow. */
  readonly nockPoint: readonly [number, number, number] | null;
  readonly hits: readonly (number | null)[];
}

export function probeOf({ state, bow }: ArcheryFrame): ArcheryProbe {
  return {
    name: 'archery',
    phase: state.phase,
    end: state.end,
    score: state.score,
    arrowsLeft: state.arrowsLeft,
    secondsLeft: secondsLeft(state),
    inZone: state.inZone,
    bowSide: bow?.bowSide ?? null,
    stage: bow?.stage ?? null,
    draw: bow?.draw ?? 0,
    nockPoint: bow && [bow.nockPoint.x, bow.nockPoint.y, bow.nockPoint.z],
    hits: state.arrows.map(({ landing }) => landing?.target ?? null),
  };
}

/** The round in the numbers of a scoreboard. */
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
function movedTo(place: Vec3, { frame, buttons }: PlayerInput): PlayerInput {
  const moved = (hand: TrackedPose | null) => hand && { ...hand, position: add(hand.position, place) };
  return { frame: { ...frame, leftHand: moved(frame.leftHand), rightHand: moved(frame.rightHand) }, buttons };
}

/** `seed` gives each round its own layout. */
export function createArcheryPlay(
  calibration: Calibration,
  settings: () => ArcherySettings,
  seed: () => number,
): ArcheryPlay {
  let match: Match<ArcheryState, ArcheryAction, ArcheryEvent>;
  let archer: Archer;
  let steered: SteeredArcher;
  let newest: ArcheryFrame | null = null;
  /** The time of the newest frame on the page's clock [s]. */
  let followedAt = Number.NaN;
  /** The target at which a pointer drew last; null: none, or the arrow was put back. */
  let drawnAt: number | null = null;
  /** The point that a pointer aimed at last, arena frame. */
  let aimedAt: Vec3 | null = null;
  let signalled = false;
  let otherHands = false;
  const gestures = new ArcheryGestures(() => ({
    ...defaultArcheryGestureSettings,
    bowSide: settings().bowSide,
    oneHanded: settings().oneHanded,
    armed: isArmed(match.state),
  }));

  function restart(person: Calibration, eyeHeight = person.eyeHeight): void {
    const { bowSide, everyHitCounts, startSignal, seconds } = settings();
    match = createMatch(
      archeryRules,
      archeryRules.start(['archer'], seed(), {
        eyeHeight,
        everyHitCounts,
        startedBy: startSignal ? 'signal' : 'arrow',
        ...(seconds && { seconds }),
      }),
      {
        delayed,
      },
    );
    const body = { bowSide, eyeHeight, armLength: chestSpaceBody(person).arm };
    archer = createArcher(body);
    steered = createSteeredArcher(body);
    newest = null;
    signalled = false;
  }
  restart(calibration);

  return {
    get targets() {
      return match.state.targets;
    },
    get newest() {
      return newest;
    },
    follow(frame, buttons) {
      const { bow, actions, cues, haptics } = gestures.follow(
        otherHands ? { ...frame, suspended: true } : frame,
        buttons,
      );
      otherHands = false;
      const signals: readonly ArcheryAction[] = signalled ? [{ type: 'start' }] : [];
      signalled = false;
      const events = match.advance(frame.time, [...signals, ...actions]);
      const { state } = match;
      const before = state.phase === 'over' ? newest : null;
      const time = before ? before.time + Math.max(0, frame.time - followedAt) : matchTime(state) + match.lead;
      followedAt = frame.time;
      newest = { state, time: Math.max(0, time), bow, events, cues, haptics };
      return newest;
    },
    act: (time) => archer.follow(time, match.state),
    steer(time, pointer, place = zero) {
      const aim = aimOf(pointer.origin, pointer.direction, match.state.targets);
      const pressed = pointer.isHeldFor(owner);
      const { cancelled } = pointer;
      if (pressed) drawnAt = aim.target;
      else if (cancelled) drawnAt = null;
      // Until the hands are back from a shot, a gaze can rest on no other target: its hold would not be heeded.
      const heeded = !steered.recovers || aim.target === drawnAt;
      if (aim.target !== null && isArmed(match.state) && heeded) {
        pointer.pointAt({ distance: aim.distance, owner, id: `target ${aim.target}`, dwellSeconds });
      }
      // A gaze looks around, also at the menu, which a bow that followed it would cover.
      if (pointer.releases || aim.target !== null) aimedAt = aim.point;
      // The simulated archer stands in the middle of the zone: what it sees and does moves to the place.
      const input = steered.follow(time, { target: subtract(aimedAt ?? aim.point, place), pressed, cancelled });
      return movedTo(place, input);
    },
    restart,
    discontinuity: () => gestures.discontinuity(),
    handedOver() {
      otherHands = true;
    },
    signal() {
      signalled = true;
    },
  };
}
