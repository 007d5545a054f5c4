import { quat, writeQuat } from '../math/quat';
import { type Vec3, vec3, writeVec3 } from '../math/vec3';
import { addClip, type Clip, type GltfDescription, type NodeTrack, packGlb } from './gltf';
import { hipsAt, type Motion, rotationAt } from './motion';

const generator = 'threepoint';
const array = ({ x, y, z }: Vec3): number[] => [x, y, z];

/** Returns the clip of a motion without its tracks; it names the bones that are not measured. */
export const clipOf = (motion: Motion): Omit<Clip, 'tracks'> => ({
  name: 'motion',
  times: clipTimes(motion),
  extras: { notMeasured: motion.bones.filter(({ measured }) => !measured).map(({ name }) => name) },
});

/** Returns the times of the frames [s], strictly rising in single precision. */
export const clipTimes = ({ times }: Motion): Float32Array => {
  const seconds = Float32Array.from(times);
  // A clip's times rise: two that are one in single precision are parted by the smallest step there is.
  for (let i = 1; i < seconds.length; i++) if (seconds[i]! <= seconds[i - 1]!) seconds[i] = next(seconds[i - 1]!);
  return seconds;
};

const bits = new Int32Array(1);
const asFloat = new Float32Array(bits.buffer);

/** Returns the next larger number in single precision after a positive one. */
function next(value: number): number {
  asFloat[0] = value;
  bits[0]! += 1;
  return asFloat[0]!;
}

/**
 * Writes the bytes of a VRM Animation 1.0 (.vrma), in parts: T-pose at rest facing +Z, rotations against it,
 * translation of the hips alone. Legs are in it, as the format wants them, at rest: `extras.notMeasured` of the
 * animation names them. Yields the fraction [0, 1] that is done.
 */
export function* writeVrma(motion: Motion): Generator<number, readonly Uint8Array<ArrayBuffer>[]> {
  const { bones, times } = motion;
  const count = times.length;
  const nodes = bones.map(({ name, offset }, index) => {
    const children = bones.flatMap(({ parent }, child) => (parent === index ? [child] : []));
    return { name, translation: array(offset), ...(children.length > 0 && { children }) };
  });
  const description: GltfDescription = {
    asset: { version: '2.0', generator },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes,
    extensionsUsed: ['VRMC_vrm_animation'],
    extensions: {
      VRMC_vrm_animation: {
        specVersion: '1.0',
        humanoid: { humanBones: Object.fromEntries(bones.map(({ name }, node) => [name, { node }])) },
      },
    },
  };
  const tracks: NodeTrack[] = [];
  const hips = new Float32Array(3 * count);
  const place = vec3(0, 0, 0);
  for (let frame = 0; frame < count; frame++) writeVec3(hipsAt(motion, frame, place), hips, 3 * frame);
  tracks.push({ node: 0, path: 'translation', values: hips });
  const rotation = quat(0, 0, 0, 1);
  for (const [bone, { measured }] of bones.entries()) {
    if (!measured) continue;
    const values = new Float32Array(4 * count);
    for (let frame = 0; frame < count; frame++) writeQuat(rotationAt(motion, frame, bone, rotation), values, 4 * frame);
    tracks.push({ node: bone, path: 'rotation', values });
    yield bone / bones.length;
  }
  const more = addClip(description, 0, { ...clipOf(motion), tracks });
  return packGlb(description, [more]);
}
