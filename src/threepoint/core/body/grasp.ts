import { copyVec3, distance, dot, length, lerp, type MutableVec3, subtract, type Vec3, vec3 } from '../math/vec3';
import { type FingerGeometry, fingerPoints, type HandGeometry, makeFingerPoints } from './hand-geometry';
import {
  closedHand,
  copyBend,
  type FingerBend,
  type FingerName,
  fingerBend,
  fingerNames,
  flatHand,
  type MutableFingerBend,
  type MutableHandShape,
} from './hand-shape';

/**
 * Returns the signed distance [m] of a point from an object in the hand, negative inside; frame of a left wrist
 * (hand-geometry).
 */
export type Surface = (point: Vec3, finger: FingerName) => number;

const relative = vec3(0, 0, 0);

/** Returns the distance [m] of a point from a ball. */
export const distanceToBall = (point: Vec3, centre: Vec3, radius: number): number =>
  length(subtract(point, centre, relative)) - radius;

/** Returns the distance [m] of a point from an endless round rod along a unit axis. */
export function distanceToRod(point: Vec3, middle: Vec3, axis: Vec3, radius: number): number {
  subtract(point, middle, relative);
  const along = dot(relative, axis);
  return Math.sqrt(Math.max(0, dot(relative, relative) - along * along)) - radius;
}

/** The number of bisections for a joint's bend, to 0.01 rad. */
const halvings = 7;
const joints = ['knuckle', 'middle', 'end'] as const;
/** A thumb stretched away above the palm, from which it closes over an object. */
const openThumb = fingerBend(-0.3, 0.75, -0.05, -0.05);
/** A thumb opposite to the palm, from which it closes around a rod across the palm. */
const opposedThumb = fingerBend(1.2, 0.3, -0.05, -0.05);
/**
 * The hyperextension of a knuckle without force [rad], from which a finger closes that would be inside the object when
 * straight.
 */
const bentBack = 0.4;

const points = makeFingerPoints();
const at: MutableVec3 = vec3(0, 0, 0);
const bent = fingerBend(0, 0, 0, 0);
const opposed = fingerBend(0, 0, 0, 0);

/**
 * Closes each finger joint by joint, knuckle first, until its skin touches the surface; a finger that meets nothing
 * closes to a fist. A finger that is inside when straight starts bent back, and stays straight if its outer bones are
 * still inside. The thumb closes from above or in front of the palm, whichever brings it further around.
 */
export function closeAround(surface: Surface, geometry: HandGeometry, target: MutableHandShape): void {
  for (let i = 0; i < fingerNames.length; i++) {
    const name = fingerNames[i]!;
    closeFinger(surface, name, geometry[name], name === 'thumb' ? openThumb : flatHand[name], target[name]);
  }
  const { thumb } = geometry;
  if (isClear(surface, 'thumb', thumb, 0, opposedThumb)) {
    closeFinger(surface, 'thumb', thumb, opposedThumb, opposed);
    if (fromFist(thumb, opposed) < fromFist(thumb, target.thumb)) copyBend(opposed, target.thumb);
  }
  target.pinch = 0;
}

/** Returns the distance of a thumb's tip from its position in a fist [m]. */
function fromFist(thumb: FingerGeometry, bend: FingerBend): number {
  fingerPoints('thumb', thumb, closedHand.thumb, points);
  copyVec3(points[3], at);
  return distance(at, fingerPoints('thumb', thumb, bend, points)[3]);
}

function closeFinger(
  surface: Surface,
  name: FingerName,
  finger: FingerGeometry,
  open: FingerBend,
  target: MutableFingerBend,
): void {
  copyBend(open, target);
  if (name !== 'thumb' && !isClear(surface, name, finger, 0, target)) {
    target.knuckle -= bentBack;
    if (!isClear(surface, name, finger, 1, target)) target.knuckle += bentBack;
  }
  for (let joint = 0; joint < 3; joint++) closeJoint(surface, name, finger, joint as 0 | 1 | 2, target);
}

/** Bends a joint by a fraction of its way into the fist; the first joint also changes its spread. */
function bendJoint(
  name: FingerName,
  joint: 0 | 1 | 2,
  fraction: number,
  from: MutableFingerBend,
  to: MutableFingerBend,
): void {
  const closed = closedHand[name];
  copyBend(from, to);
  to[joints[joint]] += (closed[joints[joint]] - from[joints[joint]]) * fraction;
  if (joint === 0) to.spread += (closed.spread - from.spread) * fraction;
}

function closeJoint(
  surface: Surface,
  name: FingerName,
  finger: FingerGeometry,
  joint: 0 | 1 | 2,
  bend: MutableFingerBend,
): void {
  bendJoint(name, joint, 1, bend, bent);
  let free = 0;
  let met = 1;
  if (isClear(surface, name, finger, joint, bent)) free = 1;
  else {
    for (let i = 0; i < halvings; i++) {
      const fraction = (free + met) / 2;
      bendJoint(name, joint, fraction, bend, bent);
      if (isClear(surface, name, finger, joint, bent)) free = fraction;
      else met = fraction;
    }
  }
  bendJoint(name, joint, free, bend, bent);
  copyBend(bent, bend);
}

/** Returns whether the bones that a joint moves are outside. The root of a finger is in the palm and is not tested. */
function isClear(
  surface: Surface,
  name: FingerName,
  finger: FingerGeometry,
  joint: 0 | 1 | 2,
  bend: FingerBend,
): boolean {
  fingerPoints(name, finger, bend, points);
  const { rootRadius, tipRadius } = finger;
  for (let bone = joint; bone < 3; bone++) {
    const [from, to] = [points[bone as 0], points[(bone + 1) as 1]];
    for (let part = 1; part <= 2; part++) {
      if (bone === 0 && part === 1) continue;
      const radius = rootRadius + ((tipRadius - rootRadius) * (bone + part / 2)) / 3;
      if (surface(lerp(from, to, part / 2, at), name) < radius) return false;
    }
  }
  return true;
}
