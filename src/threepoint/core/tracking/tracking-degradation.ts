import { copyHandShape, type HandShape, lerpHandShape, type MutableHandShape, makeHandShape } from '../body/hand-shape';
import { copyPose, type MutableTrackedPose, makeTrackedPose, type TrackedPose } from '../math/pose';
import { fromAxisAngle, multiply, quat, slerp } from '../math/quat';
import { nextSeed, uniformFromSeed } from '../math/random';
import { type Side, sides } from '../math/side';
import { add, length, lerp, scale, setVec3, vec3 } from '../math/vec3';
import type { Mutable } from '../records';
import { camerasSee } from './camera-view';
import { deviceBodySize, mixDeviceBodies } from './device-body';
import type { TrackingFrame } from './tracking-frame';

/** The degradation of tracking that a study applies on purpose, to measure its effect on people. */
export interface DegradationSettings {
  /** The added latency [ms], up to `maxLatencyMs`. */
  readonly latencyMs?: number;
  /** Normal noise, drawn for every frame: standard deviation along and about each axis. */
  readonly trackerNoise?: { readonly positionMm: number; readonly rotationDegrees: number };
  /** Whether hands outside of the view of a headset's cameras (`camerasSee`) are lost. */
  readonly cameraView?: boolean;
  /** Each hand is lost for `seconds` at a time, after exponentially distributed waits. */
  readonly dropouts?: { readonly perMinute: number; readonly seconds: number };
}

export const maxLatencyMs = 200;
/** The number of buffered frames: the longest latency at 300 Hz. */
const kept = 64;
const handOf = { left: 'leftHand', right: 'rightHand' } as const;

class BufferedHand {
  readonly pose = makeTrackedPose();
  readonly shape = makeHandShape();
  seen = false;
  shapeKnown = false;

  store(pose: TrackedPose | null, shape: HandShape | null): void {
    this.seen = pose !== null;
    this.shapeKnown = shape !== null;
    if (pose) keepPose(pose, this.pose);
    if (shape) copyHandShape(shape, this.shape);
  }
}

function keepPose(pose: TrackedPose, target: MutableTrackedPose): void {
  copyPose(pose, target);
  target.tracking = pose.tracking;
}

class BufferedFrame {
  time = 0;
  readonly head = makeTrackedPose();
  readonly hands = { left: new BufferedHand(), right: new BufferedHand() };
  hasFingers = false;
  readonly deviceBody = new Float32Array(deviceBodySize);
  hasDeviceBody = false;

  store({ time, head, leftHand, rightHand, fingers, deviceBody }: TrackingFrame): void {
    this.time = time;
    keepPose(head, this.head);
    this.hasDeviceBody = deviceBody !== undefined;
    if (deviceBody) this.deviceBody.set(deviceBody);
    this.hasFingers = fingers !== undefined;
    this.hands.left.store(leftHand, fingers?.left ?? null);
    this.hands.right.store(rightHand, fingers?.right ?? null);
  }
}

/** The start of a hand's next loss and the end of the current one [s]. */
interface Loss {
  next: number;
  until: number;
}

type WrittenFrame = Mutable<Required<Omit<TrackingFrame, 'suspended'>>>;

const offset = vec3(0, 0, 0);
const axis = vec3(0, 0, 0);
const turn = quat(0, 0, 0, 1);

function mixPose(a: TrackedPose, b: TrackedPose, t: number, target: MutableTrackedPose): void {
  lerp(a.position, b.position, t, target.position);
  slerp(a.orientation, b.orientation, t, target.orientation);
  target.tracking = a.tracking;
}

/**
 * Degrades tracking: head and hands are delayed and noisy, and hands are lost. The device's own body is only delayed,
 * because it does not come from these trackers. Further trackers are left out. Makes no garbage.
 */
export class TrackingDegradation {
  #settings: DegradationSettings | null = null;
  /** A ring buffer; `#newest` is the index of the newest frame, `#count` the number of frames. */
  readonly #ring = Array.from({ length: kept }, () => new BufferedFrame());
  #newest = 0;
  #count = 0;
  /** The seed of the generator, see `nextRandom`; an Int32Array holds 32-bit integers without boxes. */
  readonly #seed = new Int32Array(1);
  /** Random numbers for three axes of a position and three of a rotation. */
  readonly #normals = new Float64Array(6);
  readonly #losses: Record<Side, Loss> = { left: { next: 0, until: 0 }, right: { next: 0, until: 0 } };
  #lossesDrawn = false;
  readonly #head = makeTrackedPose();
  readonly #hands = { left: makeTrackedPose(), right: makeTrackedPose() };
  readonly #shapes = { left: makeHandShape(), right: makeHandShape() };
  readonly #fingers: Record<Side, MutableHandShape | null> = { left: null, right: null };
  readonly #deviceBody = new Float32Array(deviceBodySize);
  readonly #written: WrittenFrame = {
    ...{ time: 0, head: this.#head, leftHand: null, rightHand: null },
    ...{ fingers: undefined, deviceBody: undefined, trackers: undefined },
  };

  /**
   * Sets the degradation from the next frame on; null: none. Random numbers follow from the seed and the frames' times.
   */
  configure(settings: DegradationSettings | null, seed = 0): void {
    this.#settings = settings;
    this.#seed[0] = seed;
    this.#lossesDrawn = false;
    this.reset();
  }

  /** Discards the buffered frames after a discontinuity. */
  reset(): void {
    this.#count = 0;
  }

  /**
   * Returns the degraded frame with the same time [s]: the frame itself where nothing is degraded, else one that the
   * next call overwrites.
   */
  apply(frame: TrackingFrame): TrackingFrame {
    const settings = this.#settings;
    if (!settings) return frame;
    if (frame.suspended) {
      this.reset();
      return frame;
    }
    this.#push(frame);
    const written = this.#delay(frame, settings);
    written.time = frame.time;
    if (settings.cameraView) this.#hide(written);
    if (settings.dropouts) this.#drop(written, settings.dropouts);
    if (settings.trackerNoise) this.#shake(written, settings.trackerNoise);
    return written;
  }

  #push(frame: TrackingFrame): void {
    this.#newest = (this.#newest + 1) % kept;
    this.#count = Math.min(kept, this.#count + 1);
    this.#ring[this.#newest]!.store(frame);
  }

  #frameBefore(steps: number): BufferedFrame {
    return this.#ring[(this.#newest - steps + kept) % kept]!;
  }

  /** Writes the tracking of `latencyMs` ago, between two frames; the oldest frame where the buffer is shorter. */
  #delay(frame: TrackingFrame, { latencyMs = 0 }: DegradationSettings): WrittenFrame {
    const time = frame.time - latencyMs / 1000;
    let steps = 0;
    while (steps < this.#count - 1 && this.#frameBefore(steps).time > time) steps += 1;
    const older = this.#frameBefore(steps);
    const newer = this.#frameBefore(Math.max(0, steps - 1));
    const span = newer.time - older.time;
    const fraction = span > 0 ? Math.min(1, Math.max(0, (time - older.time) / span)) : 0;
    mixPose(older.head, newer.head, fraction, this.#head);
    const written = this.#written;
    written.fingers = older.hasFingers ? this.#fingers : undefined;
    written.deviceBody = older.hasDeviceBody ? this.#deviceBody : undefined;
    const after = newer.hasDeviceBody ? newer : older;
    if (older.hasDeviceBody) mixDeviceBodies(older.deviceBody, after.deviceBody, fraction, this.#deviceBody);
    for (let i = 0; i < sides.length; i++) this.#delayHand(sides[i]!, older, newer, fraction, written);
    return written;
  }

  #delayHand(side: Side, older: BufferedFrame, newer: BufferedFrame, fraction: number, written: WrittenFrame): void {
    const before = older.hands[side];
    const after = newer.hands[side].seen ? newer.hands[side] : before;
    const pose = this.#hands[side];
    if (before.seen) mixPose(before.pose, after.pose, fraction, pose);
    written[handOf[side]] = before.seen ? pose : null;
    const shape = this.#shapes[side];
    if (before.shapeKnown) lerpHandShape(before.shape, (after.shapeKnown ? after : before).shape, fraction, shape);
    this.#fingers[side] = before.shapeKnown ? shape : null;
  }

  #hide(written: WrittenFrame): void {
    for (let i = 0; i < sides.length; i++) {
      const hand = written[handOf[sides[i]!]];
      if (hand && !camerasSee(written.head, hand.position)) written[handOf[sides[i]!]] = null;
    }
  }

  #drop(written: WrittenFrame, dropouts: NonNullable<DegradationSettings['dropouts']>): void {
    const { time } = written;
    for (let i = 0; i < sides.length; i++) {
      const side = sides[i]!;
      const loss = this.#losses[side];
      if (!this.#lossesDrawn) {
        loss.until = Number.NEGATIVE_INFINITY;
        loss.next = time + this.#wait(dropouts.perMinute);
      }
      while (time >= loss.next) {
        loss.until = loss.next + dropouts.seconds;
        loss.next = loss.until + this.#wait(dropouts.perMinute);
      }
      if (time < loss.until) written[handOf[side]] = null;
    }
    this.#lossesDrawn = true;
  }

  #shake(written: WrittenFrame, noise: NonNullable<DegradationSettings['trackerNoise']>): void {
    this.#shakePose(this.#head, noise);
    if (written.leftHand) this.#shakePose(this.#hands.left, noise);
    if (written.rightHand) this.#shakePose(this.#hands.right, noise);
  }

  #shakePose(
    { position, orientation }: MutableTrackedPose,
    noise: NonNullable<DegradationSettings['trackerNoise']>,
  ): void {
    const normals = this.#drawNormals();
    const far = noise.positionMm / 1000;
    setVec3(offset, far * normals[0]!, far * normals[1]!, far * normals[2]!);
    add(position, offset, position);
    const wide = (noise.rotationDegrees * Math.PI) / 180;
    setVec3(axis, wide * normals[3]!, wide * normals[4]!, wide * normals[5]!);
    const angle = length(axis);
    if (angle === 0) return;
    scale(axis, 1 / angle, axis);
    multiply(fromAxisAngle(axis, angle, turn), orientation, orientation);
  }

  /** Draws standard normal numbers by Box and Muller into an array that stores them without boxes; 1 − u is never 0. */
  #drawNormals(): Float64Array {
    for (let i = 0; i < this.#normals.length; i++) {
      const radius = Math.sqrt(-2 * Math.log(1 - this.#uniform()));
      this.#normals[i] = radius * Math.cos(2 * Math.PI * this.#uniform());
    }
    return this.#normals;
  }

  /** Draws the time [s] until a hand is lost. */
  #wait(perMinute: number): number {
    return (-60 * Math.log(1 - this.#uniform())) / perMinute;
  }

  /** Draws a number in [0, 1). */
  #uniform(): number {
    this.#seed[0] = nextSeed(this.#seed[0]!);
    return uniformFromSeed(this.#seed[0]!);
  }
}
