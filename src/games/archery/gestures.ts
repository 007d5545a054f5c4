import {
  allReleased,
  type Button,
  type Buttons,
  createButtonPresses,
  nothingPressed,
  pressureOf,
  releasedBelow,
} from 'threepoint/core/input/button-presses';
import {
  copyPose,
  makePose,
  seenPose,
  type TrackedPose,
  type Transform,
  transformPoint,
} from 'threepoint/core/math/pose';
import { identity, rotate } from 'threepoint/core/math/quat';
import { otherSide, type Side, sides } from 'threepoint/core/math/side';
import { addScaled, copyVec3, distance, type Vec3, vec3, zero } from 'threepoint/core/math/vec3';
import { longestStep } from 'threepoint/core/tracking/page-clock';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { fistOf } from '../fist';
import type { ArcheryAction, BowView } from './archery-state';
import { arrowLength, maximumDraw, minimumDraw } from './bow';
import { forwardOf, stringAtRest, turnBow } from './bow-hand';
import { HeldBow, holdSeconds } from './held-bow';
import { NockedArrow } from './nocked-arrow';
import { releaseInterval } from './rules';

/** What the archer, the menu and the round decide; asked for in every frame, so that all of it can change during play. */
export interface ArcheryGestureSettings {
  /** The hand that holds the bow; null: it hangs on its rest until a hand takes it. A change takes effect at once. */
  readonly bowSide: Side | null;
  /** Where the bow hangs, floor frame [m]. */
  readonly rest: Vec3;
  /** true: the hand with the bow draws by holding a button and aims where its knuckles point. */
  readonly oneHanded: boolean;
  /** false: there is no arrow to nock, because the quiver is empty or the bell has rung. */
  readonly armed: boolean;
  readonly arenaFromFloor: Transform<'arena', 'floor'>;
}

export const defaultArcheryGestureSettings: ArcheryGestureSettings = {
  bowSide: 'left',
  rest: vec3(0, 0.95, -0.45),
  oneHanded: false,
  armed: true,
  arenaFromFloor: { position: zero, orientation: identity },
};

/** A buzz for one hand. */
export interface HapticPulse {
  readonly side: Side;
  /** 0 to 1. */
  readonly strength: number;
  readonly seconds: number;
}

/**
 * Something to hear, see in a caption, or remember. taken: `side` has the bow now. near-string: a press here would nock.
 * creak: another few centimetres of draw. lost, resumed: a hand left and came back to a drawn bow. cancelled: the arrow is back
 * in the quiver.
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
    | 'lost'
    | 'resumed';
  readonly side: Side;
  /** Where it happens, floor frame. */
  readonly position: Vec3;
  /** Draw at that moment [m]. */
  readonly draw: number;
}

/**
 * What one frame of hands and buttons means. The frame, its lists and the view of the bow are the same objects in every frame, which
 * the next one overwrites; actions, pulses and cues are new ones, and may be kept.
 */
export interface GestureFrame {
  /** null: no hand holds the bow, or the hand that does has not been seen for long. */
  readonly bow: BowView | null;
  /** Arena frame, `delay` 0: the match knows where in its ticks the frame lies. */
  readonly actions: readonly ArcheryAction[];
  readonly haptics: readonly HapticPulse[];
  readonly cues: readonly BowCue[];
}

/** Turns tracked hands and their buttons into what archers do (src/games/README.md). */
export interface ArcheryGestures {
  /** Frames in the order of their time; irregular ones are fine. */
  follow(frame: TrackingFrame, buttons: Buttons): GestureFrame;
  /** The floor lies elsewhere from the next frame on. */
  jumped(): void;
}

/** A press nocks when the fist is this near to the nocking point [m]; it stays near until it is a little further away. */
export const nockReach = 0.18;
const nearMargin = 0.03;
/** Frames further apart than this [s] have a pause between them, of which the page's clock counts its longest step, give or take a rounding. */
const longestFrame = longestStep - 1e-3;

const none: readonly never[] = [];

/** The view of the bow, in memory that every frame overwrites. */
const makeView = () => ({
  bowSide: 'left' as Side,
  bow: makePose<'floor'>(),
  nockPoint: vec3(0, 0, 0),
  draw: 0,
  stage: 'empty' as BowView['stage'],
  arrow: null as BowView['arrow'],
});

/** The two hands of one frame: who holds the bow, and who is at its string. One hand may do both. */
interface Roles {
  bowSide: Side;
  stringSide: Side;
  bowHand: TrackedPose | null;
  stringHand: TrackedPose | null;
}

class BowGestures implements ArcheryGestures {
  readonly #settings: () => ArcheryGestureSettings;
  readonly #presses = createButtonPresses();
  /** The hand that was asked for last. */
  #asked: Side | null | undefined;
  readonly #bow = new HeldBow();
  #nocked: NockedArrow | null = null;
  #wasNear = false;
  #shotAt = Number.NEGATIVE_INFINITY;
  #lastTime: number | null = null;
  // Of the frame that is followed now.
  #now: ArcheryGestureSettings = defaultArcheryGestureSettings;
  #time = 0;
  #delta = 0;
  #buttons: Buttons = nothingPressed;
  readonly #hands: Record<Side, TrackedPose | null> = { left: null, right: null };
  readonly #pressed: Record<Side, readonly Button[]> = { left: none, right: none };
  readonly #roles: Roles = { bowSide: 'left', stringSide: 'right', bowHand: null, stringHand: null };
  // What it means, and the memory for it.
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
  // For one step of a frame.
  readonly #fist = vec3(0, 0, 0);
  readonly #point = vec3(0, 0, 0);

  constructor(settings: () => ArcheryGestureSettings) {
    this.#settings = settings;
  }

  follow(frame: TrackingFrame, buttons: Buttons): GestureFrame {
    this.#begin(frame, buttons);
    if (frame.suspended) this.#wait();
    else this.#result.bow = this.#play(frame);
    return this.#result;
  }

  jumped(): void {
    this.#bow.jumped();
    this.#nocked?.jumped();
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
    this.#actions.push({ type: 'stand', head: transformPoint(this.#now.arenaFromFloor, head.position) });
  }

  /** Another thing is before the page: an arrow on the string waits for the hands to come back, the bow is shown as it was. */
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
    if (this.#bow.side === null) return null;
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
    const hand = seenPose(tracked);
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

  /** The menu gives the bow to another hand. */
  #changeHands(): void {
    const { bowSide } = this.#now;
    if (bowSide === this.#asked) return;
    this.#asked = bowSide;
    if (bowSide === this.#bow.side) return;
    if (this.#bow.side) this.#cancel(this.#bow.side);
    this.#bow.giveTo(bowSide);
  }

  /** A free hand takes the bow from its rest, or out of the other hand when no arrow is on the string. */
  #take(): void {
    for (const taker of sides) {
      const hand = this.#hands[taker];
      if (!hand || taker === this.#bow.side || this.#nocked) continue;
      if (!this.#pressed[taker].some((button) => button !== 'trigger')) continue;
      const fist = fistOf(hand, this.#fist);
      if (!this.#isAtBow(fist)) continue;
      this.#bow.giveTo(taker);
      this.#wasNear = true;
      this.#cue('taken', taker, fist);
      this.#pulse(taker, 0.5, 0.04);
      // The same press shall not also nock.
      this.#pressed[taker] = none;
    }
  }

  #isAtBow(fist: Vec3): boolean {
    const { rest, oneHanded } = this.#now;
    const { side } = this.#bow;
    if (side === null) return this.#bow.isOnRestAt(fist, rest);
    const giver = this.#hands[side];
    return !oneHanded && giver !== null && this.#bow.isInHandAt(fist, side, giver);
  }

  /** An archer who stops watching for that long, has no arrows left, or puts the controller away, does not shoot on going on. */
  #mustCancel({ stringSide }: Roles): boolean {
    if (this.#delta > longestFrame || !this.#now.armed || this.#presses.changedKind(stringSide)) return true;
    return this.#nocked !== null && this.#nocked.side !== stringSide;
  }

  /** An arrow on the string goes back to the quiver. */
  #cancel(side: Side): void {
    if (!this.#nocked) return;
    this.#cue('cancelled', side, this.#bow.inHand.position);
    this.#bow.settleFrom(this.#nocked.direction);
    this.#nocked = null;
  }

  #nock(hand: TrackedPose, stringSide: Side): void {
    const { oneHanded } = this.#now;
    const bow = this.#bow.empty();
    const string = stringAtRest(bow, this.#point);
    const reach = nockReach + (this.#wasNear ? nearMargin : 0);
    const near = oneHanded || distance(fistOf(hand, this.#fist), string) <= reach;
    const button = near ? this.#pressed[stringSide][0] : undefined;
    if (near && !this.#wasNear && !button && !oneHanded) {
      this.#cue('near-string', stringSide, string);
      this.#pulse(stringSide, 0.15, 0.02);
    }
    this.#wasNear = near;
    if (!button) return;
    this.#nocked = new NockedArrow(button, stringSide, forwardOf(bow));
    this.#cue('nocked', stringSide, string);
    this.#pulse(stringSide, 0.4, 0.03);
  }

  #drawOrRelease(arrow: NockedArrow, roles: Roles): void {
    const { bowSide, stringSide, bowHand, stringHand } = roles;
    if (!bowHand || !stringHand) {
      this.#missHand(arrow, roles);
      return;
    }
    const cameBack = arrow.lostAt !== null;
    if (pressureOf(this.#buttons[stringSide], arrow.button) < releasedBelow) {
      if (cameBack) this.#cancel(stringSide);
      else this.#letGo(arrow, roles);
      return;
    }
    if (cameBack) {
      arrow.resume();
      this.#cue('resumed', stringSide, arrow.nock(this.#bow.inHand, this.#point));
    }
    arrow.opened = false;
    // Any other button puts the arrow of one hand back: a held button cannot be drawn any less.
    if (this.#now.oneHanded && this.#pressed[bowSide].some((button) => button !== arrow.button)) this.#cancel(bowSide);
    else this.#draw(arrow, stringHand, roles);
  }

  /** The button of a hand that no camera sees says nothing: many devices let go of it when they lose the hand. */
  #missHand(arrow: NockedArrow, { bowSide, stringSide, bowHand }: Roles): void {
    arrow.opened = false;
    if (arrow.lostAt === null) {
      arrow.lostAt = this.#time;
      this.#cue('lost', bowHand ? stringSide : bowSide, arrow.nock(this.#bow.inHand, this.#point));
    }
    arrow.stage = 'held';
    if (this.#time - arrow.lostAt >= holdSeconds) this.#cancel(stringSide);
  }

  #letGo(arrow: NockedArrow, roles: Roles): void {
    if (arrow.button === 'pinch' && !arrow.opened) arrow.opened = true;
    else if (arrow.draw < minimumDraw || this.#time - this.#shotAt < releaseInterval) this.#cancel(roles.stringSide);
    else this.#shoot(arrow, roles);
  }

  #draw(arrow: NockedArrow, stringHand: TrackedPose, { bowSide, stringSide }: Roles): void {
    const anchored = this.#now.oneHanded
      ? arrow.drawWithButton(this.#bow.inHand, this.#delta)
      : arrow.drawWithHand(this.#bow.inHand, fistOf(stringHand, this.#fist), this.#delta);
    if (anchored) {
      this.#cue('anchored', stringSide, arrow.nock(this.#bow.inHand, this.#point));
      this.#pulse(stringSide, 0.5, 0.03);
    }
    // The harder the string pulls, the more of it the hand feels.
    if (arrow.passesHapticNotch()) this.#pulse(stringSide, 0.08 + 0.42 * (arrow.draw / maximumDraw), 0.012);
    if (arrow.passesCreakNotch()) this.#cue('creak', bowSide, this.#bow.inHand.position);
  }

  #shoot(arrow: NockedArrow, { bowSide, stringSide }: Roles): void {
    this.#shotAt = this.#time;
    const { arenaFromFloor } = this.#now;
    const tip = arrow.nock(this.#bow.inHand, this.#point);
    addScaled(tip, arrow.direction, arrowLength, tip);
    this.#actions.push({
      type: 'release',
      position: transformPoint(arenaFromFloor, tip),
      direction: rotate(arenaFromFloor.orientation, arrow.direction),
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
      stringAtRest(view.bow, view.nockPoint);
    }
    return view;
  }
}

/** One per archer. */
export const createArcheryGestures = (settings: () => ArcheryGestureSettings): ArcheryGestures =>
  new BowGestures(settings);
