import { clamp, damp, smoothingFactor, smoothstep } from '../../math/damper';
import { type Pose, type TrackedPose, type Transform, transformPoint } from '../../math/pose';
import { identity, rotate, rotationBetween, slerp } from '../../math/quat';
import { otherSide, type Side } from '../../math/side';
import {
  add,
  addScaled,
  distance,
  dot,
  forward,
  length,
  normalise,
  subtract,
  type Vec3,
  vec3,
  zero,
} from '../../math/vec3';
import type { TrackingFrame } from '../../tracking/tracking-frame';
import {
  allReleased,
  type Button,
  type Buttons,
  createButtonPresses,
  pressureOf,
  releasedBelow,
} from '../button-presses';
import { fistOf } from '../fist';
import type { ArcheryAction, BowView } from './archery-state';
import { arrowLength, braceHeight, maximumDraw, minimumDraw } from './bow';
import { arrowRestOf, bowInHand, turnBow } from './bow-hand';

/** What the archer, the menu and the round decide; asked for in every frame, so that all of it can change during play. */
export interface ArcheryGestureSettings {
  /** The hand that holds the bow; null: it hangs on its rest until a hand takes it. A change takes effect at once. */
  readonly bowSide: Side | null;
  /** Where the bow hangs, floor frame [m]. */
  readonly rest: Vec3;
  /** true: the hand with the bow draws by holding a button and aims where its knuckles point. */
  readonly oneHanded: boolean;
  /** false: there is no arrow to nock, because the quiver is empty or the round is over. */
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

/** What one frame of hands and buttons means. */
export interface GestureFrame {
  /** null: no hand holds the bow, or the hand that does has not been seen for long. */
  readonly bow: BowView | null;
  /** Arena frame, `delay` 0: whoever steps the ticks knows when in them the frame lies. */
  readonly actions: readonly ArcheryAction[];
  readonly haptics: readonly HapticPulse[];
  readonly cues: readonly BowCue[];
}

/** Turns tracked hands and their buttons into what archers do (docs/archery.md). */
export interface ArcheryGestures {
  /** Frames in the order of their time; irregular ones are fine. */
  follow(frame: TrackingFrame, buttons: Buttons): GestureFrame;
}

/** A press nocks when the fist is this near to the nocking point [m]; it stays near until it is a little further away. */
export const nockReach = 0.18;
const nearMargin = 0.03;
/** A press takes the bow when the fist is this near to its grip in the other hand, or to the bow on its rest [m]. */
export const takeReach = 0.1;
export const restReach = 0.25;
/** The direction of a drawn arrow goes half the way to where the hands point in this time [s]. */
export const aimHalfLife = 0.05;
/** The same for one hand, which trembles more [s]. */
export const oneHandedAimHalfLife = 0.08;
/** One-handed: growth of the draw [m/s] and where it ends [m]. */
export const oneHandedDrawSpeed = 0.5;
export const oneHandedDraw = 0.6;
/** Without its arrow the bow turns half the way back to how the hand holds it in this time [s]. */
export const settleHalfLife = 0.08;
/** A hand may be lost for this long with the string drawn [s]; then the arrow goes back to the quiver. */
export const holdSeconds = 0.5;
/** Longer without a frame is a pause, not a slow device [s]. */
export const pauseSeconds = 1;

/** Below the first the bow's hand aims, above the second both hands do, between them some of each [m of draw]. */
const handAims = 0.03;
const lineAims = 0.15;
/** Cosine of the angle at which a bow that turns back is back: a quarter of a degree. */
const settled = Math.cos(Math.PI / 720);
/** The string leaves the stage `nocked` at this draw [m]. */
const drawingFrom = 0.05;
/** Anchored: at least this draw [m], changing more slowly than this [m/s] for this long [s]; until it changes by this much [m]. */
const anchorDraw = 0.25;
const anchorSpeed = 0.12;
const anchorSeconds = 0.15;
const anchorSlack = 0.05;
const drawSpeedHalfLife = 0.03;
/** The string hand feels every centimetre and a half; the bow creaks every six [m]. */
const hapticNotch = 0.015;
const creakNotch = 0.06;

/** An arrow on the string. */
interface Nocked {
  readonly button: Button;
  /** Whose button it is. */
  readonly side: Side;
  stage: Exclude<BowView['stage'], 'empty'>;
  draw: number;
  drawSpeed: number;
  /** Unit, floor frame: where the arrow points. */
  direction: Vec3;
  /** Seconds for which the draw has been steady, and the draw at which it anchored. */
  steady: number;
  anchoredAt: number;
  /** Time of the first frame that missed a hand [s]; null: both seen. */
  lostAt: number | null;
  /** An opened pinch counts with the next frame that sees the hand: fingers also seem to open when a camera loses them. */
  opened: boolean;
  feltDraw: number;
  heardDraw: number;
}

const seenHand = (hand: TrackedPose | null): TrackedPose | null => (hand?.tracking === 'tracked' ? hand : null);

const forwardOf = (bow: Pose<'floor'>): Vec3 => rotate(bow.orientation, forward);

/** The unit vector on the shorter arc from a to b, `share` of the way. */
const turnTowards = (a: Vec3, b: Vec3, share: number): Vec3 =>
  normalise(rotate(slerp(identity, rotationBetween(a, b), share), a), a);

/** One per archer. */
export function createArcheryGestures(settings: () => ArcheryGestureSettings): ArcheryGestures {
  const presses = createButtonPresses();
  let asked: Side | null | undefined;
  let bowSide: Side | null = null;
  /** As the hand held it last, before the arrow turned it, and when that was. */
  let held: { readonly bow: Pose<'floor'>; readonly time: number } | null = null;
  let nocked: Nocked | null = null;
  /** Where a bow points that is turning back after its arrow has gone, unit; null: with the hand. */
  let settling: Vec3 | null = null;
  let wasNear = false;
  let lastTime: number | null = null;
  /** The bow as it was seen last. */
  let shown: BowView | null = null;

  /** Another thing is before the page: an arrow on the string waits for the hands to come back. */
  function wait(frame: TrackingFrame): GestureFrame {
    lastTime = frame.time;
    for (const side of ['left', 'right'] as const) presses.follow(side, allReleased, false);
    if (nocked) {
      nocked.lostAt = frame.time;
      nocked.opened = false;
      nocked.stage = 'held';
    }
    if (held) held = { ...held, time: frame.time };
    const { arenaFromFloor } = settings();
    return {
      bow: shown && (nocked ? { ...shown, stage: 'held' } : shown),
      actions: [{ type: 'stand', head: transformPoint(arenaFromFloor, frame.head.position) }],
      haptics: [],
      cues: [],
    };
  }

  function follow(frame: TrackingFrame, buttons: Buttons): GestureFrame {
    if (frame.suspended) return wait(frame);
    const followed = play(frame, buttons);
    shown = followed.bow;
    return followed;
  }

  function play(frame: TrackingFrame, buttons: Buttons): GestureFrame {
    const { bowSide: wanted, rest, oneHanded, armed, arenaFromFloor } = settings();
    const actions: ArcheryAction[] = [{ type: 'stand', head: transformPoint(arenaFromFloor, frame.head.position) }];
    const haptics: HapticPulse[] = [];
    const cues: BowCue[] = [];
    const delta = lastTime === null ? 0 : Math.max(0, frame.time - lastTime);
    lastTime = frame.time;

    const hands = { left: seenHand(frame.leftHand), right: seenHand(frame.rightHand) };
    const pressed = {
      left: presses.follow('left', buttons.left, hands.left !== null),
      right: presses.follow('right', buttons.right, hands.right !== null),
    };

    const cue = (type: BowCue['type'], side: Side, position: Vec3) =>
      cues.push({ type, side, position, draw: nocked?.draw ?? 0 });
    const pulse = (side: Side, strength: number, seconds: number) => haptics.push({ side, strength, seconds });
    const cancel = (side: Side) => {
      if (!nocked) return;
      cue('cancelled', side, held ? held.bow.position : frame.head.position);
      settling = nocked.direction;
      nocked = null;
    };

    if (wanted !== asked) {
      asked = wanted;
      if (wanted !== bowSide) {
        if (bowSide) cancel(bowSide);
        bowSide = wanted;
        held = null;
        settling = null;
      }
    }
    takeBow();
    if (bowSide === null) return { bow: null, actions, haptics, cues };

    const side = bowSide;
    const stringSide = oneHanded ? side : otherSide(side);
    const bowHand = hands[side];
    const stringHand = hands[stringSide];
    if (bowHand) held = { bow: bowInHand(side, bowHand), time: frame.time };
    else if (held && !nocked && frame.time - held.time > holdSeconds) held = null;
    if (!held) return { bow: null, actions, haptics, cues };
    const inHand = held.bow;

    // Whoever stops watching for that long, has no arrows left, or puts the controller away, does not shoot when it goes on.
    const anotherHand = nocked && nocked.side !== stringSide;
    if (delta > pauseSeconds || !armed || anotherHand || presses.changedKind(stringSide)) cancel(stringSide);

    if (settling) {
      settling = turnTowards(settling, forwardOf(inHand), smoothingFactor(settleHalfLife, delta));
      if (dot(settling, forwardOf(inHand)) > settled) settling = null;
    }
    const empty = settling ? turnBow(inHand, settling) : inHand;
    const string = stringAtRest(empty);
    if (nocked) drawOrRelease(nocked);
    else if (bowHand && stringHand && armed) nock(stringHand);
    return { bow: viewed(), actions, haptics, cues };

    /** A free hand takes the bow from its rest, or out of the other hand when no arrow is on the string. */
    function takeBow(): void {
      for (const taker of ['left', 'right'] as const) {
        const hand = hands[taker];
        if (!hand || taker === bowSide || nocked) continue;
        if (!pressed[taker].some((button) => button !== 'trigger')) continue;
        const fist = fistOf(hand);
        if (bowSide === null) {
          if (distance(fist, rest) > restReach) continue;
        } else {
          const giver = hands[bowSide];
          if (oneHanded || !giver) continue;
          const bow = bowInHand(bowSide, giver);
          const toGrip = distance(fist, bow.position);
          if (toGrip > takeReach || toGrip > distance(fist, stringAtRest(bow))) continue;
        }
        bowSide = taker;
        held = null;
        settling = null;
        wasNear = true;
        cue('taken', taker, fist);
        pulse(taker, 0.5, 0.04);
        // The same press shall not also nock.
        pressed[taker] = [];
      }
    }

    function nock(hand: TrackedPose): void {
      const near = oneHanded || distance(fistOf(hand), string) <= nockReach + (wasNear ? nearMargin : 0);
      const button = near ? pressed[stringSide][0] : undefined;
      if (near && !wasNear && !button && !oneHanded) {
        cue('near-string', stringSide, string);
        pulse(stringSide, 0.15, 0.02);
      }
      wasNear = near;
      if (!button) return;
      nocked = {
        button,
        side: stringSide,
        stage: 'nocked',
        draw: 0,
        drawSpeed: 0,
        direction: forwardOf(empty),
        steady: 0,
        anchoredAt: 0,
        lostAt: null,
        opened: false,
        feltDraw: 0,
        heardDraw: 0,
      };
      cue('nocked', stringSide, string);
      pulse(stringSide, 0.4, 0.03);
    }

    function drawOrRelease(arrow: Nocked): void {
      const value = pressureOf(buttons[stringSide], arrow.button);
      if (!bowHand || !stringHand) {
        // The button of a hand that nobody sees says nothing: many devices let go of it when they lose the hand.
        arrow.opened = false;
        if (arrow.lostAt === null) cue('lost', bowHand ? stringSide : side, nockOf(arrow));
        arrow.lostAt ??= frame.time;
        arrow.stage = 'held';
        if (frame.time - arrow.lostAt >= holdSeconds) cancel(stringSide);
        return;
      }
      if (arrow.lostAt !== null) {
        arrow.lostAt = null;
        if (value < releasedBelow) {
          cancel(stringSide);
          return;
        }
        arrow.stage = arrow.draw > drawingFrom ? 'drawing' : 'nocked';
        cue('resumed', stringSide, nockOf(arrow));
      } else if (value < releasedBelow) {
        if (arrow.button === 'pinch' && !arrow.opened) arrow.opened = true;
        else if (arrow.draw < minimumDraw) cancel(stringSide);
        else shoot(arrow);
        return;
      }
      arrow.opened = false;
      if (oneHanded) {
        // Any other button puts the arrow back: a held button cannot be drawn any less.
        if (pressed[side].some((button) => button !== arrow.button)) {
          cancel(side);
          return;
        }
        drawWithButton(arrow);
      } else drawWithHand(arrow, fistOf(stringHand));
      feel(arrow);
    }

    function drawWithHand(arrow: Nocked, fist: Vec3): void {
      const reference = arrow.draw < drawingFrom ? forwardOf(inHand) : arrow.direction;
      // The arrow rest lies above the fist at right angles to the arrow, whichever way the knuckles point.
      const level = turnBow(inHand, normalise(subtract(arrowRestOf(inHand), fist), reference));
      const line = subtract(arrowRestOf(level), fist);
      const behind = dot(line, reference) > 0;
      const draw = behind ? clamp(length(line) - braceHeight, 0, maximumDraw) : 0;
      const share = smoothstep(handAims, lineAims, draw);
      const goal = behind ? turnTowards(forwardOf(inHand), normalise(line), share) : forwardOf(inHand);
      arrow.direction = turnTowards(arrow.direction, goal, smoothingFactor(aimHalfLife * share, delta));
      if (delta > 0) arrow.drawSpeed = damp(arrow.drawSpeed, (draw - arrow.draw) / delta, drawSpeedHalfLife, delta);
      arrow.draw = draw;

      const steady = draw >= anchorDraw && Math.abs(arrow.drawSpeed) < anchorSpeed;
      arrow.steady = steady ? arrow.steady + delta : 0;
      if (arrow.stage === 'anchored' && Math.abs(draw - arrow.anchoredAt) <= anchorSlack) return;
      if (arrow.steady >= anchorSeconds) anchor(arrow);
      else arrow.stage = draw > drawingFrom ? 'drawing' : 'nocked';
    }

    function drawWithButton(arrow: Nocked): void {
      arrow.direction = turnTowards(arrow.direction, forwardOf(inHand), smoothingFactor(oneHandedAimHalfLife, delta));
      arrow.draw = Math.min(oneHandedDraw, arrow.draw + oneHandedDrawSpeed * delta);
      if (arrow.draw < oneHandedDraw) arrow.stage = arrow.draw > drawingFrom ? 'drawing' : 'nocked';
      else if (arrow.stage !== 'anchored') anchor(arrow);
    }

    function anchor(arrow: Nocked): void {
      arrow.stage = 'anchored';
      arrow.anchoredAt = arrow.draw;
      cue('anchored', stringSide, nockOf(arrow));
      pulse(stringSide, 0.5, 0.03);
    }

    /** The harder the string pulls, the more of it the hand feels. */
    function feel(arrow: Nocked): void {
      const strength = 0.08 + 0.42 * (arrow.draw / maximumDraw);
      if (Math.abs(arrow.draw - arrow.feltDraw) >= hapticNotch) {
        arrow.feltDraw = arrow.draw;
        pulse(stringSide, strength, 0.012);
      }
      if (arrow.draw < arrow.heardDraw) arrow.heardDraw = arrow.draw;
      else if (arrow.draw - arrow.heardDraw >= creakNotch) {
        arrow.heardDraw = arrow.draw;
        cue('creak', side, inHand.position);
      }
    }

    function shoot(arrow: Nocked): void {
      const tip = addScaled(nockOf(arrow), arrow.direction, arrowLength);
      actions.push({
        type: 'release',
        position: transformPoint(arenaFromFloor, tip),
        direction: rotate(arenaFromFloor.orientation, arrow.direction),
        draw: arrow.draw,
        delay: 0,
      });
      cue('released', side, inHand.position);
      pulse(side, 0.4 + 0.6 * (arrow.draw / maximumDraw), 0.06);
      if (stringSide !== side) pulse(stringSide, 0.3, 0.02);
      settling = arrow.direction;
      nocked = null;
    }

    /** Where the nock is: behind the arrow rest, so that the arrow always passes the bow where it lies on it. */
    function nockOf(arrow: Nocked): Vec3 {
      return addScaled(arrowRestOf(turnBow(inHand, arrow.direction)), arrow.direction, -braceHeight - arrow.draw);
    }

    function viewed(): BowView {
      if (!nocked) {
        // An arrow that has just gone leaves the bow as it pointed.
        const bow = settling ? turnBow(inHand, settling) : inHand;
        return { bowSide: side, bow, nockPoint: stringAtRest(bow), draw: 0, stage: 'empty', arrow: null };
      }
      const nockPoint = nockOf(nocked);
      return {
        bowSide: side,
        bow: turnBow(inHand, nocked.direction),
        nockPoint,
        draw: nocked.draw,
        stage: nocked.stage,
        arrow: { nock: nockPoint, direction: nocked.direction },
      };
    }
  }

  return { follow };
}

/** The nocking point of a bow with nothing on its string. */
function stringAtRest(bow: Pose<'floor'>): Vec3 {
  return add(arrowRestOf(bow), rotate(bow.orientation, vec3(0, 0, braceHeight)));
}
