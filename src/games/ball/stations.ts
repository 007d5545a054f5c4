import type { Transform } from 'threepoint/core/math/pose';
import { fromAxisAngle, identity } from 'threepoint/core/math/quat';
import { type MutableVec3, setVec3, up, type Vec3, vec3 } from 'threepoint/core/math/vec3';
import type { BallState } from './ball-state';
import { ballRadius } from './flight';

/** From each thrower to the basket holder, along the floor [m]. */
export const throwingDistance = 5;

const aside = 0.8;
const ahead = Math.sqrt(throwingDistance * throwingDistance - aside * aside);

/** Where the floor of each seat lies in the arena: the throwers look along −Z, the holder looks back at them. */
export const stations: readonly Transform<'arena', 'floor'>[] = [
  { position: vec3(-aside, 0, 0), orientation: identity },
  { position: vec3(aside, 0, 0), orientation: identity },
  { position: vec3(0, 0, -ahead), orientation: fromAxisAngle(up, Math.PI) },
];

/** Where the floor of a seat lies in the arena: at its station in the match, or before any (null) at the station of its number. */
export function arenaFromSeatFloor(seat: number, match: BallState | null): Transform<'arena', 'floor'> {
  return stations[match?.players[seat]?.station ?? seat] ?? stations[0]!;
}

/** The station of the basket holder. */
export const holderStation = 2;

/**
 * By how many stations those who have these move on for another round, which needs a thrower and the holder: with `rotate` by one where that
 * gives a round, so that everyone has every role in turn; null where no move gives one.
 */
export function rotationForRound(taken: readonly number[], rotate: boolean): number | null {
  const gives = (by: number): boolean =>
    taken.length > 1 && taken.some((station) => (station + by) % stations.length === holderStation);
  return (rotate ? [1, 2, 0] : [0]).find(gives) ?? null;
}

/** Every player stays this near to their own station [m]. */
export const zoneRadius = 1.2;

/** Whether a head is that near to a station; arena frame. */
export function isInZone(head: Vec3, station: number): boolean {
  const { x, z } = stations[station]!.position;
  return Math.hypot(head.x - x, head.z - z) <= zoneRadius;
}

const rackHeight = 0.85;
const spacing = 0.17;
const columns = 2;

/** The first so many balls of a match belong in the first thrower's rack, the others in the second's. */
export const ballsPerRack = (balls: number): number => Math.ceil(balls / 2);

/**
 * Where a ball lies in its rack, arena frame: beside the thrower, towards the other one, so that both can reach the nearer balls
 * of both racks.
 */
export function rackPosition(ball: number, balls: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  const perRack = ballsPerRack(balls);
  const side = ball < perRack ? -1 : 1;
  const slot = ball % perRack;
  const column = slot % columns;
  const row = Math.floor(slot / columns);
  return setVec3(target, side * (aside - 0.34 - column * spacing), rackHeight + ballRadius, 0.2 - row * spacing);
}
