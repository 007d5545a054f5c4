import type { BallState } from '../games/ball/ball-state';
import { stations } from '../games/ball/stations';
import type { Transform } from '../math/pose';
import { fromAxisAngle } from '../math/quat';
import { up, vec3 } from '../math/vec3';

/** An open room is a circle this wide, everybody looking at its middle [m]. */
const circleRadius = 2.5;

/** Where the floor of a seat lies in the arena: at its station in the ball game, else on a circle. */
export function arenaFromFloorOf(seat: number, seats: number, match: BallState | null): Transform<'arena', 'floor'> {
  const station = match && stations[match.players[seat]?.station ?? seat];
  if (station) return station;
  const angle = (2 * Math.PI * seat) / Math.max(seats, 1);
  return {
    position: vec3(circleRadius * Math.sin(angle), 0, circleRadius * Math.cos(angle)),
    orientation: fromAxisAngle(up, angle),
  };
}
