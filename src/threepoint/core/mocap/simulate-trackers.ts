import { fromAxisAngle, multiply, type Quat, rotate, writeQuat } from '../math/quat';
import { createNormalRandom } from '../math/random';
import { add, length, normalise, type Vec3, vec3, writeVec3 } from '../math/vec3';
import mocapRules from './mocap-rules.json' with { type: 'json' };
import type { ResampledClip } from './resampled-clip';
import { trackedJoints } from './skeleton-map';
import { positionAt, rotationAt } from './truth-motion';

const { eyesFromHeadJoint, seed, trackers } = mocapRules;

/** The number of values of a frame: position [m] and rotation (xyzw) of headset, left wrist and right wrist. */
export const trackedWidth = 7 * trackedJoints.length;

const radians = (degrees: number): number => (degrees * Math.PI) / 180;

/** Returns the deviation for a tracker, by its index in `trackedJoints`: the headset, then the hands. */
const noiseOf = (joint: number, { head, hands }: Readonly<Record<'head' | 'hands', number>>): number =>
  joint === 0 ? head : hands;

/** Returns the next number of a standard normal distribution. */
type Normal = () => number;

/** Returns the generator for a person or a clip; NormalNumbers in Python draws the same numbers. */
const normalOf = (name: string): Normal => createNormalRandom(seed ^ checksum(name));

/** Draws three normal numbers with this standard deviation. */
const drawVector = (normal: Normal, deviation: number): Vec3 =>
  vec3(normal() * deviation, normal() * deviation, normal() * deviation);

/** Returns the rotation by |v| [rad] about v. */
const fromRotationVector = (v: Vec3): Quat => fromAxisAngle(normalise(v), length(v));

const crcTable = Int32Array.from(Array(256).keys(), (byte) => {
  let word = byte;
  for (let bit = 0; bit < 8; bit++) word = word & 1 ? (word >>> 1) ^ 0xedb88320 : word >>> 1;
  return word;
});

/** Returns the CRC-32 of a text's UTF-8. */
function checksum(text: string): number {
  const bytes = encodeURIComponent(text).replace(/%(..)/g, (_, hex: string) =>
    String.fromCharCode(Number.parseInt(hex, 16)),
  );
  let sum = -1;
  for (const unit of bytes) sum = (sum >>> 8) ^ crcTable[(sum ^ unit.charCodeAt(0)) & 0xff]!;
  return ~sum >>> 0;
}

/**
 * Draws the mounts of a person's headset and hand trackers, constant for that person: offsets [m] in the frames of head
 * and wrists, and rotations.
 */
function drawWearer(person: string): { readonly offsets: readonly Vec3[]; readonly turns: readonly Quat[] } {
  const normal = normalOf(person);
  const handTurn = radians(trackers.handTurnDegrees) / Math.sqrt(3);
  const hands = [drawVector(normal, handTurn), drawVector(normal, handTurn)].map(fromRotationVector);
  const [x, y, z] = eyesFromHeadJoint as [number, number, number];
  const eyes = add(vec3(x, y, z), drawVector(normal, trackers.headsetOffset));
  const pitch = normal() * radians(trackers.headsetPitchDegrees);
  const wrists = [drawVector(normal, trackers.wristOffset), drawVector(normal, trackers.wristOffset)];
  return { offsets: [eyes, ...wrists], turns: [fromAxisAngle(vec3(1, 0, 0), pitch), ...hands] };
}

/**
 * Simulates the poses of headset and hands for the clip of this name, `trackedWidth` numbers for each frame. They equal
 * those of the evaluation, because errors are drawn by person and clip.
 */
export function simulateTrackers(motion: ResampledClip, person: string, clip: string): Float32Array<ArrayBuffer> {
  const { offsets, turns } = drawWearer(person);
  const normal = normalOf(clip);
  const { frameCount } = motion;
  const tracked = new Float32Array(frameCount * trackedWidth);
  // All positions come before all rotations: the order in which the errors are drawn.
  for (let frame = 0; frame < frameCount; frame++) {
    for (const [index, joint] of trackedJoints.entries()) {
      const moved = rotate(rotationAt(motion, frame, index), offsets[index]!);
      const noise = drawVector(normal, noiseOf(index, trackers.positionNoise));
      writeVec3(add(add(positionAt(motion, frame, joint), moved), noise), tracked, frame * trackedWidth + 7 * index);
    }
  }
  for (let frame = 0; frame < frameCount; frame++) {
    for (const [joint, turn] of turns.entries()) {
      const jitter = radians(noiseOf(joint, trackers.rotationNoiseDegrees)) / Math.sqrt(3);
      const turned = multiply(
        multiply(rotationAt(motion, frame, joint), turn),
        fromRotationVector(drawVector(normal, jitter)),
      );
      writeQuat(turned, tracked, frame * trackedWidth + 7 * joint + 3);
    }
  }
  return tracked;
}
