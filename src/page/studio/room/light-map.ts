import { type Box, groups, room, type Side, sides, type Triple } from './room-plan';

/** Texels of a small thing per metre. */
const boxDensity = 9;
/** The width of the light map [texels]; its height is what the patches need. */
export const mapWidth = 224;
/** The light of a texel of 255. A white surface in light of 1 is as bright as white paper on the screen. */
export const brightest = 4;
/** The first texels of the map have a light of 1, for what is painted with its light. */
export const neutral = { columns: 2, rows: 2 } as const;

/** A rectangle with a part of the light map. Its first texel lies at `origin`, its last at `origin` + `u` + `v`. */
export interface Patch {
  readonly origin: Triple;
  readonly u: Triple;
  readonly v: Triple;
  /** Unit; `u` × `v` points along it. */
  readonly normal: Triple;
  readonly color: string;
  readonly columns: number;
  readonly rows: number;
  readonly side: Side | null;
  readonly box: Box | null;
  /** The place of its first texel in the map. */
  readonly x: number;
  readonly y: number;
}

type Unplaced = Omit<Patch, 'x' | 'y'>;

const names = ['x', 'y', 'z'] as const;

const triple = (at: (axis: number) => number): Triple => [at(0), at(1), at(2)];

/** Returns the rectangle of a box's side, which faces along an axis. */
function rectangle(from: Triple, to: Triple, axis: 0 | 1 | 2, facing: 1 | -1) {
  // The two axes in the order in which their cross product points along the axis, or against it.
  const first = (facing > 0 ? axis + 1 : axis + 2) % 3;
  const second = (facing > 0 ? axis + 2 : axis + 1) % 3;
  const along = (which: number) => triple((i) => (i === which ? to[i]! - from[i]! : 0));
  const origin = triple((i) => (i === axis && facing > 0 ? to[i]! : from[i]!));
  return { origin, u: along(first), v: along(second), normal: triple((i) => (i === axis ? facing : 0)) };
}

const texels = (edge: Triple, density: number): number => Math.max(2, Math.round(Math.hypot(...edge) * density) + 1);

function sidePatch(side: Side): Unplaced {
  const { axis, facing, color, density } = side;
  // The box of the room, pressed flat onto this side.
  const at = facing > 0 ? room.from[axis] : room.to[axis];
  const pressed = (point: Triple) => triple((i) => (i === axis ? at : point[i]!));
  const face = rectangle(pressed(room.from), pressed(room.to), axis, facing);
  return { ...face, color, side, box: null, columns: texels(face.u, density), rows: texels(face.v, density) };
}

function boxPatches(box: Box): Unplaced[] {
  if (box.lightThrough !== undefined) return [];
  const patches: Unplaced[] = [];
  for (const axis of [0, 1, 2] as const) {
    for (const facing of [-1, 1] as const) {
      if (box.hidden?.includes(`${facing > 0 ? '+' : '-'}${names[axis]}`)) continue;
      const face = rectangle(box.from, box.to, axis, facing);
      const [columns, rows] = [texels(face.u, boxDensity), texels(face.v, boxDensity)];
      patches.push({ ...face, color: box.color, side: null, box, columns, rows });
    }
  }
  return patches;
}

/** Returns the rectangles of the room, each with its place in the light map, and the height of the map [texels]. */
export function layOutLightMap(): { readonly patches: readonly Patch[]; readonly mapHeight: number } {
  const unplaced = [...sides.map(sidePatch), ...groups.flat().flatMap(boxPatches)];
  // Shelves of falling height; patches of one height keep their order.
  const order = unplaced.map((patch, index) => ({ patch, index }));
  order.sort((a, b) => b.patch.rows - a.patch.rows || a.index - b.index);
  const placed: Patch[] = [];
  let [x, y, shelf] = [neutral.columns as number, 0, 0];
  for (const { patch, index } of order) {
    if (x + patch.columns > mapWidth) {
      y += shelf;
      [x, shelf] = [0, 0];
    }
    shelf = Math.max(shelf, patch.rows);
    placed[index] = { ...patch, x, y };
    x += patch.columns;
  }
  return { patches: placed, mapHeight: y + shelf };
}
