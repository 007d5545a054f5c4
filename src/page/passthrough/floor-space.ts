import type { FloorNeeds } from '../activity/activity';

/** A point of the floor [m], floor frame. */
interface FloorPoint {
  readonly x: number;
  readonly z: number;
}

/** Returns whether a point lies within a polygon. */
function contains(polygon: readonly FloorPoint[], { x, z }: FloorPoint): boolean {
  let inside = false;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [a, b] = [polygon[i]!, polygon[j]!];
    if (a.z > z !== b.z > z && x < ((b.x - a.x) * (z - a.z)) / (b.z - a.z) + a.x) inside = !inside;
  }
  return inside;
}

/** The distance between the tested points of a floor [m]. */
const step = 0.25;

/** Returns whether a floor has the space that an activity needs about the origin, which looks along −Z. */
export function hasSpace(polygon: readonly FloorPoint[], { halfWidth, ahead, behind }: FloorNeeds): boolean {
  for (let x = -halfWidth; x <= halfWidth; x += step)
    for (let z = -ahead; z <= behind; z += step) if (!contains(polygon, { x, z })) return false;
  return polygon.length > 2;
}

/** WebXR's plane detection, which the types describe without its labels. */
type LabelledPlane = XRPlane & { readonly semanticLabel?: string };

/** A plane this far above or below the floor of the session is another surface [m]. */
const floorTolerance = 0.25;

/** Returns the outlines of the floors that a device has detected, floor frame; empty: it detects no planes. */
export function detectedFloors(frame: XRFrame, floorSpace: XRReferenceSpace): readonly (readonly FloorPoint[])[] {
  const floors: FloorPoint[][] = [];
  for (const plane of (frame.detectedPlanes ?? []) as Iterable<LabelledPlane>) {
    const pose = frame.getPose(plane.planeSpace, floorSpace);
    if (!pose || plane.orientation !== 'horizontal') continue;
    const isFloor = plane.semanticLabel === undefined || plane.semanticLabel === 'floor';
    if (!isFloor || Math.abs(pose.transform.position.y) > floorTolerance) continue;
    const { matrix: m } = pose.transform;
    floors.push(
      plane.polygon.map(({ x, y, z }) => ({
        x: m[0]! * x + m[4]! * y + m[8]! * z + m[12]!,
        z: m[2]! * x + m[6]! * y + m[10]! * z + m[14]!,
      })),
    );
  }
  return floors;
}
