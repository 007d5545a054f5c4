import {
  fromAxisAngle,
  identity,
  type MutableVec3,
  setVec3,
  type Transform,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import type { BallState } from './ball-state';
import { ballRadius } from './flight';

/** Distance from each thrower to the basket holder along the floor [m]. */
export const throwingDistance = 5;

const aside = 0.8;
const ahead = Math.sqrt(throwingDistance * throwingDistance - aside * aside);

/** The transform from the floor of each station to the arena: the throwers face −Z, the holder faces them. */
export const stations: readonly Transform<'arena', 'floor'>[] = [
  { position: vec3(-aside, 0, 0), orientation: identity },
  { position: vec3(aside, 0, 0), orientation: identity },
  { position: vec3(0, 0, -ahead), orientation: fromAxisAngle(up, Math.PI) },
];

/**
 * Returns the transform from a seat's floor to the arena, by its station in the match; without a match (null) by its
 * number.
 */
export function arenaFromSeatFloor(seat: number, match: BallState | null): Transform<'arena', 'floor'> {
  return stations[match?.players[seat]?.station ?? seat] ?? stations[0]!;
}

export const holderStation = 2;

/**
 * Returns by how many stations the players move on for another round, which needs a thrower and the holder: with
 * `rotate` by one if possible, so that everybody has every role in turn. null: no move permits a round.
 */
export function rotationForRound(taken: readonly number[], rotate: boolean): number | null {
  const gives = (by: number): boolean =>
    taken.length > 1 && taken.some((station) => (station + by) % stations.length === holderStation);
  return (rotate ? [1, 2, 0] : [0]).find(gives) ?? null;
}

/** Radius of a player's zone about the station [m]. */
export const zoneRadius = 1.2;

/** Returns whether a head is in the zone of a station; arena frame. */
export function isInZone(head: Vec3, station: number): boolean {
  const { x, z } = stations[station]!.position;
  return Math.hypot(head.x - x, head.z - z) <= zoneRadius;
}

const rackHeight = 0.85;
const spacing = 0.17;
const columns = 2;

/** Returns the number of balls in the first thrower's rack; the others are in the second's. */
export const ballsPerRack = (balls: number): number => Math.ceil(balls / 2);

/**
 * Writes the position of a ball in its rack, arena frame. The rack is next to its thrower, on the side of the other
 * one, so that both reach the nearer balls of both racks.
 */
export function rackPosition(ball: number, balls: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  const perRack = ballsPerRack(balls);
  const side = ball < perRack ? -1 : 1;
  const slot = ball % perRack;
  const column = slot % columns;
  const row = Math.floor(slot / columns);
  return setVec3(target, side * (aside - 0.34 - column * spacing), rackHeight + ballRadius, 0.2 - row * spacing);
}
