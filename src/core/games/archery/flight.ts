import { addScaled, dot, length, scale, subtract, type Vec3 } from '../../math/vec3';
import { fallsTo, gravity, type Launch, launchTowards, positionAt, roots } from '../ballistics';
import type { Target } from './archery-state';
import { arrowLength, arrowSpeed } from './bow';

/** The launch of an arrow let go at this draw [m], its nock here, along a unit direction. */
export const launchOf = (nock: Vec3, direction: Vec3, draw: number): Launch => ({
  position: addScaled(nock, direction, arrowLength),
  velocity: scale(direction, arrowSpeed(draw)),
});

/** A net across the range: upright, from the ground to `height`. Stops what comes from the inside. */
export interface Wall {
  readonly axis: 'x' | 'z';
  /** Where it stands on its axis [m]. */
  readonly at: number;
  /** The direction of its axis that leads into the range. */
  readonly inward: 1 | -1;
  readonly height: number;
}

/** The end of a flight. */
export interface Hit {
  /** Seconds after the release. */
  readonly after: number;
  readonly on: 'target' | 'ground' | 'wall';
  /** Index of the target; null elsewhere. */
  readonly target: number | null;
}

/** Seconds until the tip first goes through the disc from its painted side; null: it never does. */
export function reachesTarget(launch: Launch, { centre, normal, radius }: Target): number | null {
  const towards = dot(normal, launch.velocity);
  for (const time of roots(-0.5 * gravity * normal.y, towards, dot(normal, subtract(launch.position, centre)))) {
    if (time < 0 || towards - gravity * normal.y * time >= 0) continue;
    if (length(subtract(positionAt(launch, time), centre)) <= radius) return time;
  }
  return null;
}

/** Seconds until the tip is at y = 0; 0 where it starts in the ground. */
export const reachesGround = (launch: Launch): number => (launch.position.y <= 0 ? 0 : fallsTo(launch, 0));

/** Seconds until the tip goes through the net from the inside; null: it flies over, along or away from it. */
export function reachesWall(launch: Launch, { axis, at, inward, height }: Wall): number | null {
  const inside = (launch.position[axis] - at) * inward;
  const approach = -launch.velocity[axis] * inward;
  if (inside < 0 || approach <= 0) return null;
  const time = inside / approach;
  return positionAt(launch, time).y <= height ? time : null;
}

/** What the tip meets first on its parabola: solved, not stepped, so that nothing is ever too thin or too fast. */
export function firstHit(launch: Launch, targets: readonly Target[], walls: readonly Wall[]): Hit {
  let first: Hit = { after: reachesGround(launch), on: 'ground', target: null };
  for (const wall of walls) {
    const after = reachesWall(launch, wall);
    if (after !== null && after < first.after) first = { after, on: 'wall', target: null };
  }
  targets.forEach((target, index) => {
    const after = reachesTarget(launch, target);
    if (after !== null && after < first.after) first = { after, on: 'target', target: index };
  });
  return first;
}

/**
 * The unit direction in which an arrow whose nock is at `nock` must be released at this draw [m] to hit `target`: its tip lies
 * an arrow's length ahead along that direction. null: out of reach.
 */
export function releaseTowards(target: Vec3, nock: Vec3, draw: number): Vec3 | null {
  const speed = arrowSpeed(draw);
  let direction = launchTowards(target, nock, speed);
  // Each round shrinks the error by a tenth or more: the tip moves with the direction's small change alone.
  for (let round = 0; round < 12 && direction; round++) {
    direction = launchTowards(target, addScaled(nock, direction, arrowLength), speed);
  }
  return direction;
}
