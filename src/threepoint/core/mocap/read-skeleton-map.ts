import { reasonOf } from '../errors/reasons';
import { isFiniteNumber, isObject, type Json } from '../json';
import { type Vec3, vec3 } from '../math/vec3';
import { shown } from '../motion/lines';
import {
  type FileAxis,
  neededJoints,
  type SkeletonMap,
  type TrackedJoint,
  type TruthJoint,
  trackedJoints,
  truthJoints,
} from './skeleton-map';

/** The directions of a file's axes by their names in a map. */
export const directions: Readonly<Record<FileAxis, Vec3>> = {
  '+x': vec3(1, 0, 0),
  '-x': vec3(-1, 0, 0),
  '+y': vec3(0, 1, 0),
  '-y': vec3(0, -1, 0),
  '+z': vec3(0, 0, 1),
  '-z': vec3(0, 0, -1),
};

const keys = ['name', 'scale', 'frameRate', 'up', 'forward', 'joints', 'rotations', 'restFrame', 'restPose'];

/**
 * Reads the map of a skeleton from a JSON text, as the evaluation takes it (docs/accuracy.md). Throws a sentence where
 * something is missing, unknown or of the wrong kind.
 */
export function readSkeletonMap(text: string, name: string): SkeletonMap {
  const content = parse(text);
  const unknown = Object.keys(content).find((key) => !keys.includes(key));
  if (unknown !== undefined) throw new Error(`${shown(unknown)} is not known: docs/accuracy.md says what a map has`);
  const { up = '+y', forward = '+z' } = content;
  for (const [key, axis] of Object.entries({ up, forward }))
    if (!Object.hasOwn(directions, String(axis)))
      throw new Error(`“${key}” should be one of ${Object.keys(directions).join(', ')}`);
  if (String(up)[1] === String(forward)[1]) throw new Error(`“up” ${up} and “forward” ${forward} are one axis`);
  const restPose = restPoseOf(content);
  return {
    name: typeof content.name === 'string' ? content.name : name.replace(/\.json$/i, ''),
    joints: jointsOf(content),
    up: up as FileAxis,
    forward: forward as FileAxis,
    ...numberOf(content, 'scale'),
    ...numberOf(content, 'frameRate'),
    ...rotationsOf(content),
    ...restFrameOf(content),
    ...(restPose && { restPose }),
  };
}

function parse(text: string): Json {
  let content: unknown;
  try {
    content = JSON.parse(text);
  } catch (error) {
    throw new Error(`no valid JSON: ${reasonOf(error)}`);
  }
  if (!isObject(content) || !isObject(content.joints)) throw new Error('expected an object with “joints”');
  return content;
}

function jointsOf({ joints }: Json): Readonly<Partial<Record<TruthJoint, string>>> {
  const given = joints as Json;
  for (const joint of neededJoints) if (typeof given[joint] !== 'string') throw new Error(`joints.${joint} is missing`);
  for (const [joint, theirs] of Object.entries(given)) {
    if (!(truthJoints as readonly string[]).includes(joint))
      throw new Error(`joints.${joint} is none of ours (${truthJoints.join(', ')})`);
    if (typeof theirs !== 'string') throw new Error(`joints.${joint} should be the name of a joint in the file`);
  }
  return given as Partial<Record<TruthJoint, string>>;
}

function rotationsOf({ rotations = null }: Json) {
  if (rotations === null) return {};
  if (!isObject(rotations)) throw new Error('“rotations” should be an object: a joint of the file for head or hands');
  for (const [joint, theirs] of Object.entries(rotations)) {
    if (!(trackedJoints as readonly string[]).includes(joint))
      throw new Error(`rotations.${joint} is none of ${trackedJoints.join(', ')}`);
    if (typeof theirs !== 'string') throw new Error(`rotations.${joint} should be the name of a joint in the file`);
  }
  return { rotations: rotations as Partial<Record<TrackedJoint, string>> };
}

function numberOf(content: Json, key: 'scale' | 'frameRate') {
  const value = content[key] ?? null;
  if (value === null) return {};
  if (!isFiniteNumber(value) || value <= 0) throw new Error(`“${key}” should be a number above zero`);
  return { [key]: value };
}

const restFrameForm = '“restFrame” should be the number of a frame, from 1, or {"file": …, "frame": …}';
const isFrame = (value: unknown): value is number => Number.isInteger(value) && (value as number) >= 1;

function restFrameOf({ restFrame = null, restPose }: Json) {
  if (restFrame === null) return {};
  if (restPose !== undefined) throw new Error('either “restFrame” or “restPose”');
  if (isObject(restFrame)) {
    const { file, frame = 1, ...more } = restFrame;
    if (typeof file !== 'string' || Object.keys(more).length > 0 || !isFrame(frame)) throw new Error(restFrameForm);
    return { restFrame: frame, restFile: file };
  }
  if (!isFrame(restFrame)) throw new Error(restFrameForm);
  return { restFrame };
}

function restPoseOf({ restPose = null }: Json): Readonly<Record<string, readonly number[]>> | null {
  if (restPose === null) return null;
  if (!isObject(restPose)) throw new Error("“restPose” should be an object: angles [degrees] by the file's joint");
  for (const [joint, angles] of Object.entries(restPose))
    if (!Array.isArray(angles) || !angles.every(isFiniteNumber))
      throw new Error(`restPose.${joint} should be a list of angles [degrees]`);
  return restPose as Record<string, number[]>;
}
