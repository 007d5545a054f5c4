import {
  allReleased,
  type Button,
  ButtonPresses,
  type Buttons,
  type HapticPulse,
  maxStepSeconds,
  nothingPressed,
  playingHand,
  pressureOf,
  releasedBelow,
  type TrackingFrame,
} from 'threepoint/core';
import {
  addScaled,
  copyPose,
  copyVec3,
  distance,
  makePose,
  otherSide,
  type Side,
  sides,
  type TrackedPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { fistOf } from '../fist';
import type { ArcheryAction, BowView } from './archery-state';
import { arrowLength, maximumDraw, minimumDraw } from './bow';
import { bowDirection, nockingPointOf, turnBow } from './bow-pose';
import { HeldBow, holdSeconds } from './held-bow';
import { NockedArrow } from './nocked-arrow';
import { releaseInterval } from './rules';

/** Settings of the gestures, which are read in every frame and may change during play. */
export interface ArcheryGestureSettings {
  /** The hand that holds the bow. A change applies at once. */
  readonly bowSide: Side;
  /** Whether one hand does both: it draws by holding a button and aims along its knuckles. */
  readonly oneHanded: boolean;
  /** Whether there is an arrow to nock: the quiver is not empty, and the bell has not rung. */
  readonly armed: boolean;
}

export const defaultArcheryGestureSettings: ArcheryGestureSettings = {
  bowSide: 'left',
  oneHanded: false,
  armed: true,
};

/**
 * A cue for sounds, captions and logs. taken: `side` has the bow now. near-string: a press here would nock. creak:
 * another few centimetres of draw. lost, resumed: a hand was lost and tracked again at a drawn bow. cancelled: the
 * arrow is back in the quiver. too-soon: so it is, because the string was never drawn to `minimumDraw`.
 */
export interface BowCue {
  readonly type:
    | 'taken'
    | 'near-string'
    | 'nocked'
    | 'creak'
    | 'anchored'
    | 'released'
    | 'cancelled'
    | 'too-soon'
    | 'lost'
    | 'resumed';
  readonly side: Side;
  /** Position of the cue, floor frame [m]. */
  readonly position: Vec3;
  /** Draw at that moment [m]. */
  readonly draw: number;
}

/**
 * The gestures of one frame. The frame, its lists and the view of the bow are reused by the next frame; actions, pulses
 * and cues are new objects.
 */
export interface GestureFrame {
  /** The bow; null: no hand holds it, or its hand has been lost for long. */
  readonly bow: BowView | null;
  /** Actions in the arena frame (the archer's floor frame) with `delay` 0: the match adds the delay in its tick. */
  readonly actions: readonly ArcheryAction[];
  readonly haptics: readonly HapticPulse[];
  readonly cues: readonly BowCue[];
}

/** A press nocks within this distance of the fist from the nocking point [m]; the margin is hysteresis. */
const nockReach = 0.18;
const nearMargin = 0.03;

const none: readonly never[] = [];

/** Creates the view of the bow, which every frame overwrites. */
const makeView = () => ({
  bowSide: 'left' as Side,
  bow: makePose<'floor'>(),
  nockPoint: vec3(0, 0, 0),
  draw: 0,
  stage: 'empty' as BowView['stage'],
  arrow: null as BowView['arrow'],
});

/** The roles of the hands in one frame: one holds the bow, one is at its string; one hand may do both. */
interface Roles {
  bowSide: Side;
  stringSide: Side;
  bowHand: TrackedPose | null;
  stringHand: TrackedPose | null;
}

/** Turns tracked hands and their buttons into archery actions (src/games/README.md). */
export class ArcheryGestures {
  readonly #settings: () => ArcheryGestureSettings;
  readonly #presses = new ButtonPresses();
  /** The last `bowSide` of the settings. */
  #requestedSide: Side | null = null;
  readonly #bow = new HeldBow();
  #nocked: NockedArrow | null = null;
  #wasNear = false;
  #shotAt = Number.NEGATIVE_INFINITY;
  #lastTime: number | null = null;
  // The frame that is being processed.
  #now: ArcheryGestureSettings = defaultArcheryGestureSettings;
  #time = 0;
  #delta = 0;
  #buttons: Buttons = nothingPressed;
  readonly #hands: Record<Side, TrackedPose | null> = { left: null, right: null };
  readonly #pressed: Record<Side, readonly Button[]> = { left: none, right: none };
  readonly #roles: Roles = { bowSide: 'left', stringSide: 'right', bowHand: null, stringHand: null };
  // The result, and its buffers.
  readonly #actions: ArcheryAction[] = [];
  readonly #haptics: HapticPulse[] = [];
  readonly #cues: BowCue[] = [];
  readonly #view = makeView();
  readonly #arrowView = { nock: this.#view.nockPoint, direction: vec3(0, 0, 0) };
  readonly #result = {
    bow: null as BowView | null,
    actions: this.#actions,
    haptics: this.#haptics,
    cues: this.#cues,
  };
  readonly #fist = vec3(0, 0, 0);
  readonly #point = vec3(0, 0, 0);

  constructor(settings: () => ArcheryGestureSettings) {
    this.#settings = settings;
  }

  /** Processes a frame; times must rise, at any interval. The result is valid until the next call. */
  follow(frame: TrackingFrame, buttons: Buttons): GestureFrame {
    this.#begin(frame, buttons);
    if (frame.suspended) this.#wait();
    else this.#result.bow = this.#play(frame);
    return this.#result;
  }

  /** Announces that the floor frame jumps before the next frame. */
  discontinuity(): void {
    this.#bow.discontinuity();
    this.#nocked?.discontinuity();
  }

  #begin({ time, head }: TrackingFrame, buttons: Buttons): void {
    this.#now = this.#settings();
    this.#buttons = buttons;
    this.#delta = this.#lastTime === null ? 0 : Math.max(0, time - this.#lastTime);
    this.#time = time;
    this.#lastTime = time;
    this.#haptics.length = 0;
    this.#cues.length = 0;
    this.#actions.length = 0;
    this.#actions.push({ type: 'stand', head: copyVec3(head.position) });
  }

  /** Handles a suspended session: an arrow on the string waits for the hands, and the bow is shown as it was. */
  #wait(): void {
    for (const side of sides) this.#presses.follow(side, allReleased, false);
    this.#bow.wait(this.#time);
    if (!this.#nocked) return;
    this.#nocked.lostAt = this.#time;
    this.#nocked.opened = false;
    this.#nocked.stage = 'held';
    this.#view.stage = 'held';
  }

  #play(frame: TrackingFrame): BowView | null {
    this.#look('left', frame.leftHand);
    this.#look('right', frame.rightHand);
    this.#changeHands();
    this.#take();
    const roles = this.#rolesOf(this.#bow.side);
    this.#bow.follow(roles.bowSide, roles.bowHand, this.#time, this.#nocked !== null);
    if (!this.#bow.isHeld) return null;
    if (this.#mustCancel(roles)) this.#cancel(roles.stringSide);
    this.#bow.settle(this.#delta);
    if (this.#nocked) this.#drawOrRelease(this.#nocked, roles);
    else if (roles.bowHand && roles.stringHand && this.#now.armed) this.#nock(roles.stringHand, roles.stringSide);
    return this.#show(roles.bowSide);
  }

  #look(side: Side, tracked: TrackedPose | null): void {
    const hand = playingHand(tracked, this.#buttons[side]);
    this.#hands[side] = hand;
    this.#pressed[side] = this.#presses.follow(side, this.#buttons[side], hand !== null);
  }

  #rolesOf(bowSide: Side): Roles {
    const roles = this.#roles;
    roles.bowSide = bowSide;
    roles.stringSide = this.#now.oneHanded ? bowSide : otherSide(bowSide);
    roles.bowHand = this.#hands[bowSide];
    roles.stringHand = this.#hands[roles.stringSide];
    return roles;
  }

  #cue(type: BowCue['type'], side: Side, position: Vec3): void {
    this.#cues.push({ type, side, position: copyVec3(position), draw: this.#nocked?.draw ?? 0 });
  }

  #pulse(side: Side, strength: number, seconds: number): void {
    this.#haptics.push({ side, strength, seconds });
  }

  /** Gives the bow to the hand that the settings name, if that has changed. */
  #changeHands(): void {
    const { bowSide } = this.#now;
    if (bowSide === this.#requestedSide) return;
    this.#requestedSide = bowSide;
    if (bowSide === this.#bow.side) return;
    this.#cancel(this.#bow.side);
    this.#bow.moveToHand(bowSide);
  }

  /** Lets a free hand take the bow out of the other one while no arrow is nocked. */
  #take(): void {
    for (const taker of sides) {
      const hand = this.#hands[taker];
      if (!hand || taker === this.#bow.side || this.#nocked) continue;
      if (!this.#pressed[taker].some((button) => button !== 'trigger')) continue;
      const fist = fistOf(hand, this.#fist);
      if (!this.#isAtBow(fist)) continue;
      this.#bow.moveToHand(taker);
      this.#wasNear = true;
      this.#cue('taken', taker, fist);
      this.#pulse(taker, 0.5, 0.04);
      // This press must not also nock.
      this.#pressed[taker] = none;
    }
  }

  #isAtBow(fist: Vec3): boolean {
    const { side } = this.#bow;
    const giver = this.#hands[side];
    return !this.#now.oneHanded && giver !== null && this.#bow.isInHandAt(fist, side, giver);
  }

  /** Returns whether to cancel the shot: after a pause, without arrows, or when the input device has changed. */
  #mustCancel({ stringSide }: Roles): boolean {
    if (this.#delta > maxStepSeconds + 1e-6 || !this.#now.armed || this.#presses.changedKind(stringSide)) return true;
    return this.#nocked !== null && this.#nocked.side !== stringSide;
  }

  /** Returns a nocked arrow to the quiver. */
  #cancel(side: Side): void {
    if (!this.#nocked) return;
    this.#cue('cancelled', side, this.#bow.inHand.position);
    this.#bow.settleFrom(this.#nocked.direction);
    this.#nocked = null;
  }

  #nock(hand: TrackedPose, stringSide: Side): void {
    const { oneHanded } = this.#now;
    const bow = this.#bow.empty();
    const string = nockingPointOf(bow, this.#point);
    const reach = nockReach + (this.#wasNear ? nearMargin : 0);
    const near = oneHanded || distance(fistOf(hand, this.#fist), string) <= reach;
    const button = near ? this.#pressed[stringSide][0] : undefined;
    if (near && !this.#wasNear && !button && !oneHanded) {
      this.#cue('near-string', stringSide, string);
      this.#pulse(stringSide, 0.15, 0.02);
    }
    this.#wasNear = near;
    if (!button) return;
    this.#nocked = new NockedArrow(button, stringSide, bowDirection(bow));
    this.#cue('nocked', stringSide, string);
    this.#pulse(stringSide, 0.4, 0.03);
  }

  #drawOrRelease(arrow: NockedArrow, roles: Roles): void {
    const { bowSide, stringSide, bowHand, stringHand } = roles;
    if (!bowHand || !stringHand) {
      this.#onLostHand(arrow, roles);
      return;
    }
    const cameBack = arrow.lostAt !== null;
    if (pressureOf(this.#buttons[stringSide], arrow.button) < releasedBelow) {
      if (cameBack) this.#cancel(stringSide);
      else this.#release(arrow, roles);
      return;
    }
    if (cameBack) {
      arrow.resume();
      this.#cue('resumed', stringSide, arrow.nock(this.#bow.inHand, this.#point));
    }
    arrow.opened = false;
    // With one hand any other button cancels, because a held button cannot reduce the draw.
    if (this.#now.oneHanded && this.#pressed[bowSide].some((button) => button !== arrow.button)) this.#cancel(bowSide);
    else this.#draw(arrow, stringHand, roles);
  }

  /** Handles a lost hand. Its button is ignored: many devices release it when they lose the hand. */
  #onLostHand(arrow: NockedArrow, { bowSide, stringSide, bowHand }: Roles): void {
    arrow.opened = false;
    if (arrow.lostAt === null) {
      arrow.lostAt = this.#time;
      this.#cue('lost', bowHand ? stringSide : bowSide, arrow.nock(this.#bow.inHand, this.#point));
    }
    arrow.stage = 'held';
    if (this.#time - arrow.lostAt >= holdSeconds) this.#cancel(stringSide);
  }

  #release(arrow: NockedArrow, roles: Roles): void {
    if (arrow.button === 'pinch' && !arrow.opened) arrow.opened = true;
    else if (arrow.draw >= minimumDraw && this.#time - this.#shotAt >= releaseInterval) this.#shoot(arrow, roles);
    else {
      this.#cancel(roles.stringSide);
      if (arrow.longestDraw < minimumDraw) this.#cue('too-soon', roles.stringSide, this.#bow.inHand.position);
    }
  }

  #draw(arrow: NockedArrow, stringHand: TrackedPose, { bowSide, stringSide }: Roles): void {
    const anchored = this.#now.oneHanded
      ? arrow.drawWithButton(this.#bow.inHand, this.#delta)
      : arrow.drawWithHand(this.#bow.inHand, fistOf(stringHand, this.#fist), this.#delta);
    if (anchored) {
      this.#cue('anchored', stringSide, arrow.nock(this.#bow.inHand, this.#point));
      this.#pulse(stringSide, 0.5, 0.03);
    }
    // The pulse grows with the draw.
    if (arrow.passesHapticNotch()) this.#pulse(stringSide, 0.08 + 0.42 * (arrow.draw / maximumDraw), 0.012);
    if (arrow.passesCreakNotch()) this.#cue('creak', bowSide, this.#bow.inHand.position);
  }

  #shoot(arrow: NockedArrow, { bowSide, stringSide }: Roles): void {
    this.#shotAt = this.#time;
    const tip = arrow.nock(this.#bow.inHand, this.#point);
    addScaled(tip, arrow.direction, arrowLength, tip);
    this.#actions.push({
      type: 'release',
      position: copyVec3(tip),
      direction: copyVec3(arrow.direction),
      draw: arrow.draw,
      delay: 0,
    });
    this.#cue('released', bowSide, this.#bow.inHand.position);
    this.#pulse(bowSide, 0.4 + 0.6 * (arrow.draw / maximumDraw), 0.06);
    if (stringSide !== bowSide) this.#pulse(stringSide, 0.3, 0.02);
    this.#bow.settleFrom(arrow.direction);
    this.#nocked = null;
  }

  #show(bowSide: Side): BowView {
    const view = this.#view;
    const arrow = this.#nocked;
    view.bowSide = bowSide;
    view.draw = arrow?.draw ?? 0;
    view.stage = arrow?.stage ?? 'empty';
    view.arrow = arrow && this.#arrowView;
    if (arrow) {
      turnBow(this.#bow.inHand, arrow.direction, view.bow);
      arrow.nock(this.#bow.inHand, view.nockPoint);
      copyVec3(arrow.direction, this.#arrowView.direction);
    } else {
      copyPose(this.#bow.empty(), view.bow);
      nockingPointOf(view.bow, view.nockPoint);
    }
    return view;
  }
}
