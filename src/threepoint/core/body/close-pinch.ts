import { smoothstep } from '../math/damper';
import {
  addScaled,
  copyVec3,
  cross,
  distance,
  dot,
  type MutableVec3,
  normalise,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../math/vec3';
import { fingerPoints, type HandGeometry, makeFingerPoints } from './hand-geometry';
import { fullPinchDistance, noPinchDistance } from './hand-joints';
import {
  copyBend,
  type FingerName,
  fingerBend,
  limitBend,
  type MutableFingerBend,
  type MutableHandShape,
} from './hand-shape';

/** The overlap of touching fingertips [fraction of the sum of their radii]. */
const pressedIn = 0.45;
/** The pinch from which the tips are moved fully; below it in part. */
const wholeFrom = 0.35;
const steps = 5;
/** Damping of the solution [m]: a straight finger cannot move its tip along itself. */
const damping = 0.006;
const probe = 1e-3;

/** Returns the distance of the tips [m] for a pinch in [0, 1]: the inverse of `pinchOf`. */
const gapOf = (pinch: number): number => {
  const open = 0.5 - Math.sin(Math.asin(2 * pinch - 1) / 3);
  return fullPinchDistance + (noPinchDistance - fullPinchDistance) * open;
};

const thumbPoints = makeFingerPoints();
const indexPoints = makeFingerPoints();
const between = vec3(0, 0, 0);
const toThumb = vec3(0, 0, 0);
const toIndex = vec3(0, 0, 0);

/**
 * Bends thumb and index finger of a hand with this geometry until the distance of their tips matches the pinch. On
 * another hand the same angles would leave a gap or miss. A shape without a pinch stays as it is.
 */
export function closePinch(shape: MutableHandShape, geometry: HandGeometry): void {
  const { thumb, index, pinch } = shape;
  if (!(pinch > 0)) return;
  const fraction = smoothstep(0, wholeFrom, pinch);
  const touching = (1 - pressedIn) * (geometry.thumb.tipRadius + geometry.index.tipRadius);
  let wanted = 0;
  for (let step = 0; step < steps; step++) {
    const thumbTip = fingerPoints('thumb', geometry.thumb, thumb, thumbPoints)[3];
    const indexTip = fingerPoints('index', geometry.index, index, indexPoints)[3];
    const gap = distance(thumbTip, indexTip);
    // In the first step the distance follows from the angles alone.
    if (step === 0) wanted = gap + (touching + gapOf(Math.min(pinch, 1)) - fullPinchDistance - gap) * fraction;
    if (Math.abs(gap - wanted) < 2e-4) return;
    normalise(subtract(indexTip, thumbTip, between), up, between);
    addScaled(thumbTip, between, (gap - wanted) / 2, toThumb);
    addScaled(indexTip, between, (wanted - gap) / 2, toIndex);
    reach('thumb', geometry, thumb, toThumb);
    reach('index', geometry, index, toIndex);
  }
}

const parameters = ['knuckle', 'spread', 'middle'] as const;
const columns = [vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0)] as const;
const rows = [vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0)] as const;
const error = vec3(0, 0, 0);
const solution = vec3(0, 0, 0);
const points = makeFingerPoints();
const tip = vec3(0, 0, 0);
const moved = fingerBend(0, 0, 0, 0);

/**
 * Moves a finger's tip towards a point by one step of damped least squares; the end joint bends half as far as the
 * middle one.
 */
function reach(name: FingerName, geometry: HandGeometry, bend: MutableFingerBend, place: Vec3): void {
  copyVec3(fingerPoints(name, geometry[name], bend, points)[3], tip);
  subtract(place, tip, error);
  for (let i = 0; i < 3; i++) {
    bendFurther(copyBend(bend, moved), i as 0 | 1 | 2, probe);
    const column = columns[i as 0 | 1 | 2];
    subtract(fingerPoints(name, geometry[name], moved, points)[3], tip, column);
    setVec3(column, column.x / probe, column.y / probe, column.z / probe);
  }
  const [a, b, c] = columns;
  setVec3(
    rows[0],
    a.x * a.x + b.x * b.x + c.x * c.x,
    a.x * a.y + b.x * b.y + c.x * c.y,
    a.x * a.z + b.x * b.z + c.x * c.z,
  );
  setVec3(rows[1], rows[0].y, a.y * a.y + b.y * b.y + c.y * c.y, a.y * a.z + b.y * b.z + c.y * c.z);
  setVec3(rows[2], rows[0].z, rows[1].z, a.z * a.z + b.z * b.z + c.z * c.z);
  rows[0].x += damping * damping;
  rows[1].y += damping * damping;
  rows[2].z += damping * damping;
  solve(rows, error, solution);
  for (let i = 0; i < 3; i++) bendFurther(bend, i as 0 | 1 | 2, dot(columns[i as 0 | 1 | 2], solution));
  limitBend(bend, bend);
}

function bendFurther(bend: MutableFingerBend, parameter: 0 | 1 | 2, angle: number): void {
  bend[parameters[parameter]] += angle;
  if (parameter === 2) bend.end += angle / 2;
}

const minor = vec3(0, 0, 0);

/** Solves a symmetric system of three equations by Cramer's rule. */
function solve([a, b, c]: readonly [Vec3, Vec3, Vec3], right: Vec3, target: MutableVec3): void {
  const determinant = dot(a, cross(b, c, minor));
  const x = dot(right, minor) / determinant;
  const y = dot(right, cross(c, a, minor)) / determinant;
  const z = dot(right, cross(a, b, minor)) / determinant;
  setVec3(target, x, y, z);
}
