import { allReleased, type HandButtons } from 'threepoint/core';
import {
  add,
  addScaled,
  clamp,
  dot,
  forward,
  fromAxisAngle,
  lerp,
  multiply,
  normalise,
  otherSide,
  type Pose,
  type Quat,
  reject,
  right,
  rotate,
  type Side,
  scale,
  slerp,
  subtract,
  type TrackedPose,
  up,
  type Vec3,
  vec3,
  zero,
} from 'threepoint/math';
import { wristAround } from '../fist';
import {
  armRatio,
  halfShoulderRatio,
  lookAlong,
  shoulderBehindRatio,
  shoulderDropRatio,
  swayAt,
  yawOf,
} from '../simulated-body';
import type { SimulatedInput } from '../simulated-input';
import { arrowRestHeight, braceHeight, maximumDraw } from './bow';
import { releaseDirection } from './flight';

export interface ArcherBody {
  readonly bowSide: Side;
  /** Height of the eyes above the floor [m], standing or seated. */
  readonly eyeHeight: number;
  /** Shoulder to wrist [m]. Default: the average for a standing person with this eye height. */
  readonly armLength?: number;
}

/** Turn of the trunk away from the target [rad], when ready and when drawing: the bow shoulder leads. */
const readyTurn = 0.45;
const drawnTurn = 1.05;

/** Roll of the string hand [rad]; 0: thumb up and elbow low, π/2: palm down and elbow high. */
const elbowLift = 0.95;

/** A bow and the hand on its string at one moment, relative to the eyes, arena axes. */
interface Hold {
  /** The arrow rest, at which the arrow passes the bow. */
  readonly arrowRest: Vec3;
  /** Direction of the arrow, unit. */
  readonly direction: Vec3;
  /** Draw beyond brace height [m]. */
  readonly draw: number;
}

/** A posture: the gaze, the yaw of the trunk, the bow, and the string hand while it is not on the string. */
export interface Posture {
  readonly gaze: Quat;
  readonly trunkYaw: number;
  readonly hold: Hold;
  /** The string hand relative to the eyes [m], while `onString` is 0; with 1 it is at the nock, along the arrow. */
  readonly free: { readonly fist: Vec3; readonly knuckles: Vec3; readonly thumb: Vec3 };
  readonly onString: number;
}

const mixHold = (a: Hold, b: Hold, share: number): Hold => ({
  arrowRest: lerp(a.arrowRest, b.arrowRest, share),
  direction: normalise(lerp(a.direction, b.direction, share)),
  draw: a.draw + (b.draw - a.draw) * share,
});

export const mixPostures = (a: Posture, b: Posture, share: number): Posture => ({
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

/** The postures of one archer, and their head, hands and buttons. The floor of the archer is that of the arena. */
export class ArcherPostures {
  /** The eyes of the archer at the centre of the zone, arena frame. */
  readonly eyes: Vec3;
  readonly #bowSide: Side;
  readonly #stringSide: Side;
  readonly #arm: number;
  readonly #halfShoulders: number;
  /** The sign of x on the side of the string hand. */
  readonly #stringSign: -1 | 1;

  constructor({ bowSide, eyeHeight, armLength = armRatio * eyeHeight }: ArcherBody) {
    this.eyes = vec3(0, eyeHeight, 0);
    this.#bowSide = bowSide;
    this.#stringSide = otherSide(bowSide);
    this.#arm = armLength;
    this.#halfShoulders = (halfShoulderRatio / armRatio) * armLength;
    this.#stringSign = bowSide === 'left' ? 1 : -1;
  }

  /** Returns a resting posture that faces a yaw [rad, 0: ahead, positive: to the left]. */
  resting(yaw: number): Posture {
    const arm = this.#arm;
    const gaze = fromAxisAngle(up, yaw);
    const trunkYaw = yaw - this.#stringSign * 0.2;
    const bow = this.#shoulderOf(this.#bowSide, gaze, trunkYaw);
    const string = this.#shoulderOf(this.#stringSide, gaze, trunkYaw);
    return {
      gaze,
      trunkYaw,
      hold: {
        arrowRest: add(bow, this.#facing(yaw, -0.05 * arm, -0.8 * arm, 0.42 * arm)),
        direction: normalise(this.#facing(yaw, -0.1, -0.75, 0.65)),
        draw: 0,
      },
      free: {
        fist: add(string, this.#facing(yaw, 0.2 * arm, -0.98 * arm, 0.14 * arm)),
        knuckles: this.#facing(yaw, 0, -1, 0.15),
        thumb: this.#facing(yaw, -0.15, 0, 1),
      },
      onString: 0,
    };
  }

  /** Returns the posture with the bow at the chest, and the string hand about to take an arrow. */
  ready(yaw: number): Posture {
    const arm = this.#arm;
    const gaze = multiply(fromAxisAngle(up, yaw - this.#stringSign * 0.12), fromAxisAngle(right, -0.3));
    const trunkYaw = yaw - this.#stringSign * readyTurn;
    const bow = this.#shoulderOf(this.#bowSide, gaze, trunkYaw);
    const string = this.#shoulderOf(this.#stringSide, gaze, trunkYaw);
    return {
      gaze,
      trunkYaw,
      hold: {
        arrowRest: add(bow, this.#facing(yaw, 0.3 * arm, -0.34 * arm, 0.68 * arm)),
        direction: normalise(this.#facing(yaw, -0.15, -0.3, 1)),
        draw: 0,
      },
      // The free hand is at the belt quiver.
      free: {
        ...this.resting(yaw).free,
        fist: add(string, this.#facing(yaw, 0.16 * arm, -0.88 * arm, 0.02 * arm)),
      },
      onString: 0,
    };
  }

  /** Returns full draw, aimed to hit a point of the arena. */
  drawn(target: Vec3): Posture {
    const arm = this.#arm;
    const to = subtract(target, this.eyes);
    const yaw = yawOf(to);
    const gaze = lookAlong(to);
    const trunkYaw = yaw - this.#stringSign * drawnTurn;
    const nock = this.#facing(yaw, 0.14 * arm, -0.17 * arm, 0.16 * arm);
    const shoulder = this.#shoulderOf(this.#bowSide, gaze, trunkYaw);
    const atNock = add(this.eyes, nock);
    let draw = 0.4;
    let direction = normalise(to);
    // Draw and direction depend on each other: a longer draw is faster and flies flatter.
    for (let round = 0; round < 6; round++) {
      direction = releaseDirection(target, atNock, draw) ?? normalise(to);
      draw = this.#drawOf(nock, shoulder, direction);
    }
    return {
      gaze,
      trunkYaw,
      hold: { arrowRest: addScaled(nock, direction, braceHeight + draw), direction, draw },
      free: { fist: nock, knuckles: direction, thumb: this.#hooked(direction) },
      onString: 1,
    };
  }

  /** Returns the posture just after the release. */
  followedThrough(shot: Posture): Posture {
    const { arrowRest, direction, draw } = shot.hold;
    const nock = addScaled(arrowRest, direction, -braceHeight - draw);
    const back = rotate(fromAxisAngle(up, 0.5 * this.#stringSign), scale(direction, -1));
    return {
      ...shot,
      free: { fist: addScaled(nock, back, 0.12 * this.#arm), knuckles: direction, thumb: this.#hooked(direction) },
      onString: 0,
    };
  }

  /**
   * Returns head, hands (floor frame) and buttons of a posture at a time [s]. `pressure`: on the string hand's button,
   * 0 to 1. `swing`: outward offset of that hand [m].
   */
  inputFor(now: Posture, time: number, pressure: number, swing: number): SimulatedInput {
    const head = add(this.eyes, swayAt(time));
    const bowHand = this.#inFloor(head, this.#bowWrist(now));
    const stringHand = this.#inFloor(head, this.#stringWrist(now, swing));
    const pressed: HandButtons = { ...allReleased, trigger: pressure };
    const left = this.#bowSide === 'left';
    return {
      frame: {
        time,
        head: this.#inFloor(zero, { position: head, orientation: now.gaze }),
        leftHand: left ? bowHand : stringHand,
        rightHand: left ? stringHand : bowHand,
      },
      buttons: { left: left ? allReleased : pressed, right: left ? pressed : allReleased },
    };
  }

  /** Returns the vector of (towards the string side, up, ahead) for an archer that faces a yaw. */
  #facing(yaw: number, outward: number, upward: number, ahead: number): Vec3 {
    return rotate(fromAxisAngle(up, yaw), vec3(this.#stringSign * outward, upward, -ahead));
  }

  /** Returns the thumb of the hand on the string, which leans inward because the elbow is behind the arrow. */
  #hooked(direction: Vec3): Vec3 {
    return this.#facing(yawOf(direction), -Math.sin(elbowLift), Math.cos(elbowLift), 0);
  }

  /**
   * Returns a shoulder relative to the eyes. The neck lies behind the eyes along the gaze; the trunk turns about it.
   */
  #shoulderOf(side: Side, gaze: Quat, trunkYaw: number): Vec3 {
    const arm = this.#arm;
    const half = this.#halfShoulders;
    const neck = this.#facing(yawOf(rotate(gaze, forward)), 0, -shoulderDropRatio * arm, -shoulderBehindRatio * arm);
    return add(neck, this.#facing(trunkYaw, side === this.#stringSide ? half : -half, 0, 0));
  }

  /** Returns the draw [m] at which the bow arm is nearly straight. */
  #drawOf(nock: Vec3, shoulder: Vec3, direction: Vec3): number {
    const wrist = wristAround(this.#bowSide, zero, direction, up).position;
    const upper = normalise(reject(up, direction));
    // From the shoulder to the wrist: start + direction·length, as long as a nearly straight arm.
    const start = add(subtract(nock, shoulder), addScaled(wrist, upper, -arrowRestHeight));
    const along = dot(start, direction);
    const room = (0.97 * this.#arm) ** 2 - dot(start, start) + along * along;
    return clamp(Math.sqrt(Math.max(0, room)) - along - braceHeight, 0.2, maximumDraw);
  }

  #bowWrist({ hold: { arrowRest, direction } }: Posture): Pose<'arena'> {
    const upper = normalise(reject(up, direction));
    return wristAround<'arena'>(this.#bowSide, addScaled(arrowRest, upper, -arrowRestHeight), direction, up);
  }

  #stringWrist({ hold, free, onString, trunkYaw }: Posture, swing: number): Pose<'arena'> {
    const { arrowRest, direction, draw } = hold;
    const nock = addScaled(arrowRest, direction, -braceHeight - draw);
    return wristAround<'arena'>(
      this.#stringSide,
      add(lerp(free.fist, nock, onString), this.#facing(trunkYaw, swing, 0, 0)),
      lerp(free.knuckles, direction, onString),
      lerp(free.thumb, this.#hooked(direction), onString),
    );
  }

  /** Returns the pose, given relative to `origin`, in the floor frame. */
  #inFloor(origin: Vec3, { position, orientation }: Pose<'arena'>): TrackedPose {
    return { position: add(origin, position), orientation, tracking: 'tracked' };
  }
}
