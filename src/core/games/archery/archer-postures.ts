import { clamp } from '../../math/damper';
import { type Pose, type TrackedPose, type Transform, transformPose } from '../../math/pose';
import { fromAxisAngle, identity, multiply, type Quat, rotate, slerp } from '../../math/quat';
import { otherSide, type Side } from '../../math/side';
import {
  add,
  addScaled,
  dot,
  lerp,
  normalise,
  reject,
  scale,
  subtract,
  up,
  type Vec3,
  vec3,
  zero,
} from '../../math/vec3';
import type { TrackingFrame } from '../../tracking/tracking-frame';
import { allReleased, type Button, type Buttons, type HandButtons } from '../button-presses';
import { wristAround } from '../fist';
import { armShare, lookAlong, shoulderBehind, shoulderDrop, shoulderShare, yawOf } from '../posture';
import { arrowRestHeight, braceHeight, maximumDraw } from './bow';
import { releaseTowards } from './flight';

/** Who shoots. */
export interface ArcherBody {
  readonly bowSide: Side;
  /** Height of the eyes above the floor [m], standing or seated as the archer is. */
  readonly eyeHeight: number;
  /** Shoulder to wrist [m]. Default: that of a person who stands with eyes at this height. */
  readonly armLength?: number;
  /** The button that the string hand presses. */
  readonly button?: Button;
  /** Where the range lies in the room; default: the zone's middle is the floor's origin. */
  readonly floorFromArena?: Transform<'floor', 'arena'>;
}

/** The bow shoulder goes ahead: the trunk turns this far away from the target [rad], standing ready and drawing. */
const readyTurn = 0.45;
const drawnTurn = 1.05;

/** Roll of the string hand [rad]: 0 thumb up and elbow low, a quarter turn: palm down and elbow high. */
const elbowLift = 0.95;

/** A bow and the hand on its string at one moment, relative to the eyes, arena axes. */
export interface Hold {
  /** Where the arrow passes the bow. */
  readonly arrowRest: Vec3;
  /** Unit: where the arrow would point. */
  readonly direction: Vec3;
  /** Draw beyond brace height [m]. */
  readonly draw: number;
}

/** Everything that moves: head and trunk by their yaw, the bow, and the string hand where it is not on the string. */
export interface Posture {
  readonly gaze: Quat;
  readonly trunkYaw: number;
  readonly hold: Hold;
  /** Fist of the string hand from the eyes [m] and its knuckles; `onString` 1: at the nock, along the arrow. */
  readonly free: { readonly fist: Vec3; readonly knuckles: Vec3; readonly thumb: Vec3 };
  readonly onString: number;
}

const mixHold = (a: Hold, b: Hold, share: number): Hold => ({
  arrowRest: lerp(a.arrowRest, b.arrowRest, share),
  direction: normalise(lerp(a.direction, b.direction, share)),
  draw: a.draw + (b.draw - a.draw) * share,
});

export const mix = (a: Posture, b: Posture, share: number): Posture => ({
  gaze: slerp(a.gaze, b.gaze, share),
  trunkYaw: a.trunkYaw + (b.trunkYaw - a.trunkYaw) * share,
  hold: mixHold(a.hold, b.hold, share),
  free: {
    fist: lerp(a.free.fist, b.free.fist, share),
    knuckles: lerp(a.free.knuckles, b.free.knuckles, share),
    thumb: lerp(a.free.thumb, b.free.thumb, share),
  },
  onString: a.onString + (b.onString - a.onString) * share,
});

/** The postures of one archer, and what they look like to a headset and two hands. */
export interface ArcherPostures {
  /** Of the eyes, standing at the zone's middle, arena frame. */
  readonly eyes: Vec3;
  /** Standing about, facing this yaw [rad, 0: ahead, positive: to the left]. */
  resting(yaw: number): Posture;
  /** The bow up at the chest, low towards the target, the string hand on its way to an arrow. */
  ready(yaw: number): Posture;
  /** Full draw, the arrow where it must point to hit this point of the arena. */
  drawn(target: Vec3): Posture;
  /** A moment after the release from this posture. */
  followedThrough(shot: Posture): Posture;
  /**
   * Head, hands (floor frame) and buttons in a posture at a time [s]; pressure: of the string hand's button, 0 to 1; swing: how far
   * that hand is off its way, outward [m].
   */
  seen(
    posture: Posture,
    time: number,
    pressure: number,
    swing: number,
  ): { readonly frame: TrackingFrame; readonly buttons: Buttons };
}

/** How an archer of this body stands, draws and lets go. */
export function createArcherPostures(body: ArcherBody): ArcherPostures {
  const { bowSide, eyeHeight, button = 'trigger' } = body;
  const arm = body.armLength ?? armShare * eyeHeight;
  const shoulders = (shoulderShare / armShare) * arm;
  const floorFromArena = body.floorFromArena ?? { position: zero, orientation: identity };
  const stringSide = otherSide(bowSide);
  /** Towards the string hand's side, as a factor of +X. */
  const aside = bowSide === 'left' ? 1 : -1;
  const eyes = vec3(0, eyeHeight, 0);

  /** A vector given as (towards the string side, up, ahead) of an archer who faces this yaw. */
  const facing = (yaw: number, outward: number, upward: number, ahead: number): Vec3 =>
    rotate(fromAxisAngle(up, yaw), vec3(aside * outward, upward, -ahead));

  /** The thumb of the hand on the string: leaning inward, as it does with an elbow behind the arrow rather than under it. */
  const hooked = (direction: Vec3): Vec3 => facing(yawOf(direction), -Math.sin(elbowLift), Math.cos(elbowLift), 0);

  /** A shoulder from the eyes: the trunk turns under a neck that lies behind the eyes along the gaze's yaw. */
  function shoulderOf(side: Side, gaze: Quat, trunkYaw: number): Vec3 {
    const neck = facing(yawOf(rotate(gaze, vec3(0, 0, -1))), 0, -shoulderDrop * arm, -shoulderBehind * arm);
    return add(neck, facing(trunkYaw, side === stringSide ? shoulders : -shoulders, 0, 0));
  }

  /** Standing about, the bow low before the thigh, facing this yaw. */
  function resting(yaw: number): Posture {
    const gaze = fromAxisAngle(up, yaw);
    const trunkYaw = yaw - aside * 0.2;
    const bow = shoulderOf(bowSide, gaze, trunkYaw);
    const string = shoulderOf(stringSide, gaze, trunkYaw);
    return {
      gaze,
      trunkYaw,
      hold: {
        arrowRest: add(bow, facing(yaw, -0.05 * arm, -0.8 * arm, 0.42 * arm)),
        direction: normalise(facing(yaw, -0.1, -0.75, 0.65)),
        draw: 0,
      },
      free: {
        fist: add(string, facing(yaw, 0.2 * arm, -0.98 * arm, 0.14 * arm)),
        knuckles: facing(yaw, 0, -1, 0.15),
        thumb: facing(yaw, -0.15, 0, 1),
      },
      onString: 0,
    };
  }

  /** The bow up at the chest, pointing low towards the target, its string within reach of the other hand. */
  function ready(yaw: number): Posture {
    const gaze = multiply(fromAxisAngle(up, yaw - aside * 0.12), fromAxisAngle(vec3(1, 0, 0), -0.3));
    const trunkYaw = yaw - aside * readyTurn;
    const bow = shoulderOf(bowSide, gaze, trunkYaw);
    const before = resting(yaw);
    return {
      gaze,
      trunkYaw,
      hold: {
        arrowRest: add(bow, facing(yaw, 0.3 * arm, -0.34 * arm, 0.68 * arm)),
        direction: normalise(facing(yaw, -0.15, -0.3, 1)),
        draw: 0,
      },
      // Between belt quiver and string the free hand is where an arrow is taken.
      free: {
        ...before.free,
        fist: add(shoulderOf(stringSide, gaze, trunkYaw), facing(yaw, 0.16 * arm, -0.88 * arm, 0.02 * arm)),
      },
      onString: 0,
    };
  }

  /** Full draw at a target: the nock beside the chin, the bow arm nearly straight, the arrow where it must point to hit. */
  function drawn(target: Vec3): Posture {
    const to = subtract(target, eyes);
    const yaw = yawOf(to);
    const gaze = lookAlong(to);
    const trunkYaw = yaw - aside * drawnTurn;
    const nock = facing(yaw, 0.14 * arm, -0.17 * arm, 0.16 * arm);
    const shoulder = shoulderOf(bowSide, gaze, trunkYaw);
    let draw = 0.4;
    let direction = normalise(to);
    // Draw and direction depend on each other, a little: a longer draw is faster and flies flatter.
    for (let round = 0; round < 6; round++) {
      direction = releaseTowards(target, add(eyes, nock), draw) ?? normalise(to);
      const wrist = wristAround(bowSide, zero, direction, up).position;
      const upper = normalise(reject(up, direction));
      // From the shoulder to the wrist: start + direction·length, as long as a nearly straight arm.
      const start = add(subtract(nock, shoulder), addScaled(wrist, upper, -arrowRestHeight));
      const along = dot(start, direction);
      const room = (0.97 * arm) ** 2 - dot(start, start) + along * along;
      draw = clamp(Math.sqrt(Math.max(0, room)) - along - braceHeight, 0.2, maximumDraw);
    }
    return {
      gaze,
      trunkYaw,
      hold: { arrowRest: addScaled(nock, direction, braceHeight + draw), direction, draw },
      free: { fist: nock, knuckles: direction, thumb: hooked(direction) },
      onString: 1,
    };
  }

  /** The bow where it was, the string at rest, the string hand gone on backward: a moment after the release. */
  function followedThrough(shot: Posture): Posture {
    const { arrowRest, direction, draw } = shot.hold;
    const nock = addScaled(arrowRest, direction, -braceHeight - draw);
    const back = rotate(fromAxisAngle(up, 0.5 * aside), scale(direction, -1));
    return {
      ...shot,
      free: { fist: addScaled(nock, back, 0.12 * arm), knuckles: direction, thumb: hooked(direction) },
      onString: 0,
    };
  }

  const inFloor = (pose: Pose<'arena'>): TrackedPose => ({
    ...transformPose(floorFromArena, pose),
    tracking: 'tracked',
  });

  return {
    eyes,
    resting,
    ready,
    drawn,
    followedThrough,
    seen(now, time, pressure, swing) {
      // No archer stands still: head, bow and string hand drift together, millimetres.
      const drift = vec3(
        0.006 * Math.sin(time * 0.61),
        0.002 * Math.sin(time * 1.5),
        0.005 * Math.sin(time * 0.43 + 1),
      );
      const head = add(eyes, drift);
      const { arrowRest, direction, draw } = now.hold;
      const upper = normalise(reject(up, direction));
      const bowWrist = wristAround<'arena'>(bowSide, addScaled(arrowRest, upper, -arrowRestHeight), direction, up);
      const nock = addScaled(arrowRest, direction, -braceHeight - draw);
      const stringWrist = wristAround<'arena'>(
        stringSide,
        add(lerp(now.free.fist, nock, now.onString), facing(now.trunkYaw, swing, 0, 0)),
        lerp(now.free.knuckles, direction, now.onString),
        lerp(now.free.thumb, hooked(direction), now.onString),
      );
      const atHead = (wrist: Pose<'arena'>): TrackedPose =>
        inFloor({ position: add(head, wrist.position), orientation: wrist.orientation });
      const hands = { [bowSide]: atHead(bowWrist), [stringSide]: atHead(stringWrist) } as Record<Side, TrackedPose>;
      const pressed: HandButtons = { ...allReleased, [button]: pressure };
      const buttons = { [bowSide]: allReleased, [stringSide]: pressed } as Record<Side, HandButtons>;
      return {
        frame: {
          time,
          head: inFloor({ position: head, orientation: now.gaze }),
          leftHand: hands.left,
          rightHand: hands.right,
        },
        buttons,
      };
    },
  };
}
