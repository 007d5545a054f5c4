import { allReleased, type Button, type Buttons, type HandButtons, type TrackingFrame } from 'threepoint/core';
import {
  add,
  addScaled,
  cross,
  identity,
  normalise,
  otherSide,
  reject,
  type Side,
  type TrackedPose,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { wristAround } from 'threepoint-games';
import { ArcheryGestures, type BowView, braceHeight } from 'threepoint-games/archery';
import { arrowRestHeight } from '../../../src/games/archery/bow';
import {
  type ArcheryGestureSettings,
  defaultArcheryGestureSettings,
  type GestureFrame,
} from '../../../src/games/archery/gestures';

/** What an archer does in one frame who holds the bow out and has the other hand on the line of the arrow. */
export interface Posed {
  readonly bowSide?: Side;
  /** The distance of the string hand behind brace height [m]; −0.16 is at the bow itself. */
  readonly draw?: number;
  /** The distance of the string hand to the right of the line [m]. */
  readonly off?: number;
  readonly direction?: Vec3;
  /** The direction of the bow hand's knuckles; default: along the arrow. */
  readonly knuckles?: Vec3;
  readonly bowAt?: Vec3;
  readonly lost?: readonly Side[];
  readonly emulated?: readonly Side[];
}

/** The fist of the bow hand, unless a test says otherwise. */
export const bowAt: Vec3 = vec3(-0.1, 1.4, -0.6);

export function posed(time: number, pose: Posed = {}): TrackingFrame {
  const { bowSide = 'left', draw = 0, off = 0, lost = [], emulated = [] } = pose;
  const direction = normalise(pose.direction ?? vec3(0, 0, -1));
  const fist = pose.bowAt ?? bowAt;
  const rest = addScaled(fist, normalise(reject(up, direction)), arrowRestHeight);
  const string = add(
    addScaled(rest, direction, -braceHeight - draw),
    addScaled(vec3(0, 0, 0), normalise(cross(direction, up)), off),
  );
  const hand = (side: Side): TrackedPose | null => {
    if (lost.includes(side)) return null;
    const wrist =
      side === bowSide
        ? wristAround<'floor'>(side, fist, pose.knuckles ?? direction, up)
        : wristAround<'floor'>(side, string, direction, up);
    return { ...wrist, tracking: emulated.includes(side) ? 'emulated' : 'tracked' };
  };
  return {
    time,
    head: { position: vec3(0, 1.6, 0), orientation: identity, tracking: 'tracked' },
    leftHand: hand('left'),
    rightHand: hand('right'),
  };
}

const moments = (from: number, to: number, rateHz: number): number[] =>
  Array.from({ length: Math.round((to - from) * rateHz) }, (_, i) => from + (i + 1) / rateHz);

/** An archer who is moved step by step at a frame rate; collects all results. */
export function bowman(changes: Partial<ArcheryGestureSettings> = {}, rateHz = 90) {
  let settings: ArcheryGestureSettings = { ...defaultArcheryGestureSettings, ...changes };
  const gestures = new ArcheryGestures(() => settings);
  let time = 5;
  let frames: GestureFrame[] = [];
  const bowSide = (): Side => settings.bowSide;
  const stringSide = (): Side => (settings.oneHanded ? bowSide() : otherSide(bowSide()));

  const self = {
    /** Changes settings during play. */
    set(next: Partial<ArcheryGestureSettings>) {
      settings = { ...settings, ...next };
    },
    frame(pose: Posed, pressed: Partial<Record<Side, Partial<HandButtons>>>, seconds = 1 / rateHz): GestureFrame {
      time += seconds;
      const buttons: Buttons = {
        left: { ...allReleased, ...pressed.left },
        right: { ...allReleased, ...pressed.right },
      };
      // The gestures overwrite their result with every frame.
      const result = structuredClone(gestures.follow(posed(time, { bowSide: bowSide(), ...pose }), buttons));
      frames.push(result);
      return result;
    },
    /** The string hand presses this much for this long while `at` moves from 0 to 1. */
    move(at: (share: number) => Posed, seconds: number, pressure = 0, button: Button = 'trigger') {
      for (const moment of moments(0, seconds, rateHz)) {
        self.frame(at(moment / seconds), { [stringSide()]: { [button]: pressure } });
      }
      return self;
    },
    hold: (pose: Posed, seconds: number, pressure = 0, button: Button = 'trigger') =>
      self.move(() => pose, seconds, pressure, button),
    /** Nocks and draws so far, then holds. */
    drawTo(draw: number, pose: Posed = {}, button: Button = 'trigger') {
      self.hold({ ...pose, draw: 0 }, 0.1, 0, button);
      self.hold({ ...pose, draw: 0 }, 0.1, 1, button);
      self.move((share) => ({ ...pose, draw: draw * share }), 0.8, 1, button);
      return self.hold({ ...pose, draw }, 0.5, 1, button);
    },
    /** The floor lies elsewhere from the next frame on. */
    jump() {
      gestures.discontinuity();
      return self;
    },
    get bow(): BowView | null {
      return frames.at(-1)?.bow ?? null;
    },
    get frames() {
      return frames;
    },
    /** What was said so far, creaks left out. */
    get said() {
      return frames.flatMap(({ cues }) => cues.map(({ type }) => type)).filter((type) => type !== 'creak');
    },
    get releases() {
      return frames.flatMap(({ actions }) => actions).filter((action) => action.type === 'release');
    },
    forget() {
      frames = [];
      return self;
    },
  };
  return self;
}
