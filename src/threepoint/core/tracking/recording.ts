import { type Calibration, type GripOffset, type GripOffsets, handleFitParts } from '../body/calibration';
import { type Fingers, fingerNames, type HandShape, lerpHandShape, limitBend, makeHandShape } from '../body/hand-shape';
import type { HandTilts } from '../body/hand-tilt';
import { isFiniteNumber, isObject } from '../json';
import { clamp } from '../math/damper';
import type { TrackedPose } from '../math/pose';
import { slerp } from '../math/quat';
import { sides } from '../math/side';
import { lerp } from '../math/vec3';
import { type DeviceBody, deviceBodySize, deviceJointNames, mixDeviceBodies } from './device-body';
import type { TrackingFrame } from './tracking-frame';

/** Frames in the order of their times: an array, or an object that makes each frame on demand. */
export interface TrackingFrames extends Iterable<TrackingFrame> {
  readonly length: number;
  /** Returns the frame at an index, below 0 from the end, as an array does. */
  at(index: number): TrackingFrame | undefined;
}

/** Recorded tracking in full precision, with lost hands as null. */
export interface Recording<Frames extends TrackingFrames = readonly TrackingFrame[]> {
  /** A description of the source: a headset's name, or 'emulated headset'. */
  readonly device: string;
  /** The device's frame rate [Hz]; the frames' own times take precedence. */
  readonly rateHz: number;
  /** The person's measures; null: unknown. */
  readonly calibration: Calibration | null;
  /** One frame or more, with rising times. */
  readonly frames: Frames;
}

/** A recording whose frames need not lie in memory. */
export type Replayable = Recording<TrackingFrames>;

const format = 'threepoint-recording';
const version = 1;

const poseColumns = 7;
/** The largest distance of what is tracked from the origin, along each axis [m]. */
const farthest = 1000;
/** The number of columns of a hand: five fingers of four joints, and a pinch. */
const bendColumns = 21;
const columns =
  'time [s]; head, left hand, right hand: position [m], orientation xyzw, tracking; where known, fingers of the left hand, of the right: ' +
  'knuckle, spread, middle, end [rad] from thumb to little finger, pinch; where the device reports a body, its joints: x, y, z [m]';

/** Returns a hand's angles, rounded to a ten-thousandth of a radian. */
const fingerColumns = (shape: HandShape | null): readonly number[] | null =>
  shape &&
  [
    ...fingerNames.flatMap((name) => {
      const { knuckle, spread, middle, end } = shape[name];
      return [knuckle, spread, middle, end];
    }),
    shape.pinch,
  ].map((angle) => Math.round(1e4 * angle) / 1e4);

/** Returns a device body's joints, rounded to a tenth of a millimetre. */
const bodyNumbers = (body: DeviceBody): readonly number[] => Array.from(body, (value) => Math.round(1e4 * value) / 1e4);

/** Returns the text of a recording file: JSON with one frame per line. */
export const writeRecording = (recording: Replayable): string =>
  writeRecordingWithin(recording, Number.POSITIVE_INFINITY).text;

/**
 * Returns a recording file with as many of the first frames as fit into `maxBytes` bytes of UTF-8, at least one, and
 * their number.
 */
export function writeRecordingWithin(
  { device, rateHz, calibration, frames }: Replayable,
  maxBytes: number,
): { readonly text: string; readonly frames: number } {
  let hasBody = false;
  const pose = (tracked: TrackedPose | null) =>
    tracked && [
      ...[tracked.position.x, tracked.position.y, tracked.position.z],
      ...[tracked.orientation.x, tracked.orientation.y, tracked.orientation.z, tracked.orientation.w],
      tracked.tracking,
    ];
  const line = ({ time, head, leftHand, rightHand, fingers, deviceBody }: TrackingFrame) => {
    const poses = [time, pose(head), pose(leftHand), pose(rightHand)];
    const bent =
      fingers || deviceBody ? [fingerColumns(fingers?.left ?? null), fingerColumns(fingers?.right ?? null)] : [];
    return JSON.stringify([...poses, ...bent, ...(deviceBody ? [bodyNumbers(deviceBody)] : [])]);
  };
  const top = (joints: object) => {
    const header = JSON.stringify({ format, version, device, rateHz, calibration, ...joints });
    return `${header.slice(0, -1)},"columns":"${columns}","frames":[\n`;
  };
  const bodyJoints = { bodyJoints: deviceJointNames };
  const end = '\n]}\n';
  const lines: string[] = [];
  // Only the device's name may contain other characters than ASCII: at most three bytes each.
  let bytes = top(bodyJoints).length + 2 * device.length + end.length;
  for (const frame of frames) {
    const written = line(frame);
    bytes += written.length + ',\n'.length;
    if (lines.length > 0 && bytes > maxBytes) break;
    hasBody ||= frame.deviceBody !== undefined;
    lines.push(written);
  }
  return { text: `${top(hasBody ? bodyJoints : {})}${lines.join(',\n')}${end}`, frames: lines.length };
}

/**
 * Parses the text of a recording file. Throws a sentence that names the wrong line or frame and its fault.
 *
 * @example
 * const recording = parseRecording(await file.text());
 */
export function parseRecording(text: string): Recording {
  const file = parseJson(text);
  if (!isObject(file) || file.format !== format) throw new Error('This file is not a threepoint recording.');
  if (file.version !== version)
    throw new Error(`The recording has version ${String(file.version)}; this page reads version ${version}.`);
  if (typeof file.device !== 'string') throw new Error('The recording names no device.');
  if (!isFiniteNumber(file.rateHz) || file.rateHz <= 0) throw new Error('The recording has no frame rate in Hz.');
  if (file.bodyJoints !== undefined && JSON.stringify(file.bodyJoints) !== JSON.stringify(deviceJointNames)) {
    throw new Error('The recording’s device body has other joints than this version reads.');
  }
  if (!Array.isArray(file.frames) || file.frames.length === 0) throw new Error('The recording has no frames.');
  const frames = file.frames.map(parseFrame);
  for (let i = 1; i < frames.length; i++) {
    if (frames[i]!.time <= frames[i - 1]!.time) {
      throw new Error(`Frame ${i + 1} of the recording is not later than the one before it.`);
    }
  }
  return { device: file.device, rateHz: file.rateHz, calibration: parseCalibration(file.calibration), frames };
}

/** Returns the value of a JSON text, or the error that says where it is none. */
function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch (error) {
    return error;
  }
}

function parseJson(text: string): unknown {
  const value = parsed(text);
  if (!(value instanceof Error)) return value;
  throw new Error(`The recording is not valid JSON${placeOfSyntaxError(text, value.message)}.`);
}

/** Returns the place of a syntax error: each frame is one line, and the first line that does not parse is damaged. */
function placeOfSyntaxError(text: string, message: string): string {
  const lines = text.split('\n');
  const broken = lines.slice(1, -2).findIndex((line) => parsed(line.replace(/,\s*$/, '')) instanceof Error);
  return lines.length > 3 && broken >= 0 ? `: line ${broken + 2} is damaged` : `: ${message}`;
}

/** Returns the tilts of the hands that have one; null: neither has. */
function parseHandTilts(value: unknown): HandTilts | null {
  if (!isObject(value)) return null;
  const tiltOf = (tilt: unknown) =>
    isObject(tilt) && isFiniteNumber(tilt.pitch) && isFiniteNumber(tilt.yaw)
      ? { pitch: tilt.pitch, yaw: tilt.yaw }
      : null;
  const [left, right] = [tiltOf(value.left), tiltOf(value.right)];
  return left || right ? { ...(left && { left }), ...(right && { right }) } : null;
}

function parseGripOffset(value: unknown): GripOffset {
  if (!isObject(value)) return {};
  return Object.fromEntries(
    handleFitParts.flatMap((part) => (isFiniteNumber(value[part]) ? [[part, value[part]]] : [])),
  );
}

function parseGripOffsets(value: unknown): GripOffsets | null {
  if (!isObject(value)) return null;
  const offsets = Object.entries(value).map(([device, hands]) => {
    const held = isObject(hands) ? sides.flatMap((side) => (side in hands ? [[side, hands[side]] as const] : [])) : [];
    return [device, Object.fromEntries(held.map(([side, offset]) => [side, parseGripOffset(offset)]))];
  });
  return Object.fromEntries(offsets);
}

function parseCalibration(value: unknown): Calibration | null {
  if (value === null || value === undefined) return null;
  if (isObject(value) && isFiniteNumber(value.eyeHeight) && isFiniteNumber(value.armSpan)) {
    const { eyeHeight, armSpan, forearm, gazePitch } = value;
    const handTilts = parseHandTilts(value.handTilts);
    const gripOffsets = parseGripOffsets(value.gripOffsets);
    if (eyeHeight > 0 && armSpan > 0) {
      return {
        eyeHeight,
        armSpan,
        ...(isFiniteNumber(forearm) && { forearm }),
        ...(isFiniteNumber(gazePitch) && { gazePitch }),
        ...(handTilts && { handTilts }),
        ...(gripOffsets && { gripOffsets }),
      };
    }
  }
  throw new Error('The recording’s calibration is neither null nor an eye height and an arm span in metres.');
}

function parseFrame(value: unknown, index: number): TrackingFrame {
  const where = `Frame ${index + 1} of the recording`;
  if (!Array.isArray(value) || ![4, 6, 7].includes(value.length)) {
    const columns = 'a time, a head, a left hand and a right hand, with the fingers of both and a body or without';
    throw new Error(`${where} is not ${columns}.`);
  }
  const [time, head, leftHand, rightHand, leftFingers, rightFingers, body] = value;
  if (!isFiniteNumber(time)) throw new Error(`${where} has no time.`);
  if (head === null) throw new Error(`${where} has no head.`);
  return {
    time,
    head: parsePose(head, `${where}: the head`),
    leftHand: leftHand === null ? null : parsePose(leftHand, `${where}: the left hand`),
    rightHand: rightHand === null ? null : parsePose(rightHand, `${where}: the right hand`),
    ...(value.length > 4 && {
      fingers: {
        left: leftFingers === null ? null : parseBends(leftFingers, `${where}: the fingers of the left hand`),
        right: rightFingers === null ? null : parseBends(rightFingers, `${where}: the fingers of the right hand`),
      },
    }),
    ...(body !== undefined && { deviceBody: parseBody(body, `${where}: the body`) }),
  };
}

function parsePose(value: unknown, what: string): TrackedPose {
  if (!Array.isArray(value) || value.length !== poseColumns + 1 || !value.slice(0, poseColumns).every(isFiniteNumber)) {
    throw new Error(`${what} is not seven finite numbers and a tracking state.`);
  }
  const tracking = value[poseColumns];
  if (tracking !== 'tracked' && tracking !== 'emulated') {
    throw new Error(`${what} is neither “tracked” nor “emulated”.`);
  }
  const [px, py, pz, x, y, z, w] = value as number[];
  if (Math.max(Math.abs(px!), Math.abs(py!), Math.abs(pz!)) > farthest)
    throw new Error(`${what} is more than ${farthest} m from the origin.`);
  const orientation = { x: x!, y: y!, z: z!, w: w! };
  if (Math.abs(Math.hypot(x!, y!, z!, w!) - 1) > 1e-3)
    throw new Error(`${what} has an orientation that is not a unit quaternion.`);
  return { position: { x: px!, y: py!, z: pz! }, orientation, tracking };
}

function parseBends(value: unknown, what: string): HandShape {
  if (!Array.isArray(value) || value.length !== bendColumns || !value.every(isFiniteNumber)) {
    throw new Error(`${what} are not ${bendColumns} finite numbers.`);
  }
  const shape = makeHandShape();
  for (const [i, name] of fingerNames.entries()) {
    const [knuckle, spread, middle, end] = value.slice(4 * i, 4 * i + 4) as [number, number, number, number];
    limitBend({ knuckle, spread, middle, end }, shape[name]);
  }
  shape.pinch = clamp(value[bendColumns - 1] as number, 0, 1);
  return shape;
}

function parseBody(value: unknown, what: string): DeviceBody {
  if (!Array.isArray(value) || value.length !== deviceBodySize || !value.every(isFiniteNumber)) {
    throw new Error(`${what} is not ${deviceBodySize} finite numbers.`);
  }
  if (value.some((number) => Math.abs(number) > farthest))
    throw new Error(`${what} is more than ${farthest} m from the origin.`);
  return Float32Array.from(value);
}

/** Returns the time [s] from the first frame to the last. */
export const recordingDuration = ({ frames }: Replayable): number => frames.at(-1)!.time - frames.at(0)!.time;

/** Returns the index of the last frame that is not later than a time [s]; 0 where all are later. */
function indexAt(frames: TrackingFrames, time: number): number {
  const isLater = (index: number): boolean => frames.at(index)!.time > time;
  const last = frames.length - 1;
  const [first, end] = [frames.at(0)!.time, frames.at(-1)!.time];
  // The search starts at the index for an even frame rate, and doubles its steps.
  let low = Math.floor(clamp(end > first ? (time - first) / (end - first) : 0, 0, 1) * last);
  let high = low + 1;
  for (let step = 1; low > 0 && isLater(low); step *= 2) [low, high] = [Math.max(0, low - step), low];
  for (let step = 1; high <= last && !isLater(high); step *= 2) [low, high] = [high, high + step];
  high = Math.min(high, last + 1);
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (isLater(middle)) high = middle;
    else low = middle;
  }
  return low;
}

/**
 * Returns the interpolated frame at a time [s] on the recording's clock; before the first and after the last that
 * frame. A hand that either neighbour lacks is null, and a device body that either lacks is absent.
 */
export function sampleRecording({ frames }: Replayable, time: number): TrackingFrame {
  const low = indexAt(frames, time);
  const before = frames.at(low)!;
  const after = frames.at(Math.min(low + 1, frames.length - 1))!;
  const fraction = after.time > before.time ? (time - before.time) / (after.time - before.time) : 0;
  if (fraction <= 0) return { ...before, time };
  const hand = (a: TrackedPose | null, b: TrackedPose | null) => a && b && interpolate(a, b, fraction);
  return {
    time,
    head: interpolate(before.head, after.head, fraction),
    leftHand: hand(before.leftHand, after.leftHand),
    rightHand: hand(before.rightHand, after.rightHand),
    ...(before.fingers && { fingers: mixFingers(before.fingers, after.fingers ?? before.fingers, fraction) }),
    ...(before.deviceBody &&
      after.deviceBody && { deviceBody: mixDeviceBodies(before.deviceBody, after.deviceBody, fraction) }),
  };
}

function mixFingers(a: Fingers, b: Fingers, fraction: number): Fingers {
  const hand = (from: HandShape | null, to: HandShape | null) => from && to && lerpHandShape(from, to, fraction);
  return { left: hand(a.left, b.left), right: hand(a.right, b.right) };
}

const interpolate = (a: TrackedPose, b: TrackedPose, fraction: number): TrackedPose => ({
  position: lerp(a.position, b.position, fraction),
  orientation: slerp(a.orientation, b.orientation, fraction),
  tracking: a.tracking === 'tracked' && b.tracking === 'tracked' ? 'tracked' : 'emulated',
});
