import type { Transform } from 'threepoint/core/math/pose';
import { fromAxisAngle } from 'threepoint/core/math/quat';
import { up, vec3 } from 'threepoint/core/math/vec3';

/** Radius of the circle on which many bodies are placed [m]. */
const radius = 2.5;

/** Returns the pose of a body's floor in the arena: bodies stand on a circle and face its centre. */
export function arenaFromCirclePlace(place: number, places: number): Transform<'arena', 'floor'> {
  const angle = (2 * Math.PI * place) / places;
  return {
    position: vec3(radius * Math.sin(angle), 0, radius * Math.cos(angle)),
    orientation: fromAxisAngle(up, angle),
  };
}
