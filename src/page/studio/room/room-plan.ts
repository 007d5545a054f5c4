/** A point or a size [m]: x, y, z of the floor frame. The user stands at the origin and looks along −Z. */
export type Triple = readonly [number, number, number];

/** An opening in a wall or in the ceiling, from its lowest to its highest corner [m]. */
export interface Opening {
  readonly from: Triple;
  readonly to: Triple;
}

/** One side of the room: a rectangle that faces inwards. */
export interface Side {
  readonly name: 'floor' | 'ceiling' | 'left' | 'right' | 'front' | 'back';
  /** The axis that it is perpendicular to, and the direction that it faces along it. */
  readonly axis: 0 | 1 | 2;
  readonly facing: 1 | -1;
  readonly openings: readonly Opening[];
  readonly color: string;
  /** Texels of the light map per metre. */
  readonly density: number;
}

/** A box of one colour; two opposite corners [m]. */
export interface Box {
  readonly from: Triple;
  readonly to: Triple;
  readonly color: string;
  /** The sides that nobody sees are not drawn, as '-x' for the one that faces along −X. */
  readonly hidden?: string;
  /** A plant's box is not drawn. It throws a shadow, through which this share of the light falls. */
  readonly lightThrough?: number;
}

/** A plant in a pot on the floor [m]. */
export interface Plant {
  readonly x: number;
  readonly z: number;
  readonly height: number;
  readonly seed: number;
}

/** The inside of the room [m]. The mirror hangs on the wall that the user looks at. */
export const room = { from: [-2.9, 0, -1.445], to: [3.1, 2.9, 4.8] } as const satisfies Opening;
/** How far the floor outside lies below the floor of the room [m]. */
export const gardenDepth = 0.2;
/** The direction to the sun; unit. */
export const towardsSun: Triple = [-0.705, 0.616, -0.352];

const plaster = '#f0e7da';
const lime = '#f5f0e8';
const oak = '#a9794c';
const darkOak = '#7d5636';
const painted = '#eee9e0';
const linen = '#d9cdb8';
const clay = '#b7664a';
const indigo = '#44597a';

const frontWindow: Opening = { from: [room.from[0], 0.45, -1.05], to: [room.from[0], 2.45, 0.85] };
const sideWindow: Opening = { from: [room.from[0], 0.45, 1.75], to: [room.from[0], 2.45, 3.65] };
const veranda: Opening = { from: [-1.9, 0, room.to[2]], to: [1.9, 2.45, room.to[2]] };
const skylight: Opening = { from: [0.5, room.to[1], 1.55], to: [1.9, room.to[1], 3.05] };

export const sides: readonly Side[] = [
  { name: 'floor', axis: 1, facing: 1, openings: [], color: '#c49d74', density: 26 },
  { name: 'ceiling', axis: 1, facing: -1, openings: [skylight], color: lime, density: 8 },
  { name: 'left', axis: 0, facing: 1, openings: [frontWindow, sideWindow], color: plaster, density: 11 },
  { name: 'right', axis: 0, facing: -1, openings: [], color: plaster, density: 13 },
  { name: 'front', axis: 2, facing: 1, openings: [], color: plaster, density: 10 },
  { name: 'back', axis: 2, facing: -1, openings: [veranda], color: plaster, density: 11 },
];

const box = (from: Triple, to: Triple, color: string, hidden?: string): Box =>
  hidden ? { from, to, color, hidden } : { from, to, color };

/** A window in the left wall: a lining as deep as the wall, a sill, and bars that divide it into six panes. */
function windowFrame({ from: [x, low, near], to: [, high, far] }: Opening): Box[] {
  const [out, deep] = [x - 0.2, x + 0.012];
  const middle = (near + far) / 2;
  const bar = (y0: number, y1: number, z0: number, z1: number) => box([x - 0.14, y0, z0], [x - 0.09, y1, z1], painted);
  return [
    box([out, high - 0.04, near], [deep, high, far], painted),
    box([out, low, near], [deep, high - 0.04, near + 0.04], painted),
    box([out, low, far - 0.04], [deep, high - 0.04, far], painted),
    box([out, low - 0.035, near - 0.05], [x + 0.09, low, far + 0.05], oak),
    bar(low, high - 0.04, middle - 0.03, middle + 0.03),
    ...[1.12, 1.8].flatMap((y) => [
      bar(y - 0.018, y + 0.018, near + 0.04, middle - 0.03),
      bar(y - 0.018, y + 0.018, middle + 0.03, far - 0.04),
    ]),
  ];
}

/** The glass front to the veranda: posts, a transom, rails of the doors, and the deck outside. */
function verandaFrame({ from: [left, , z], to: [right, high] }: Opening): Box[] {
  const posts = [left + 0.04, left / 2, 0, right / 2, right - 0.04];
  const bays = posts.slice(1).map((to, index) => [posts[index]! + 0.04, to - 0.04] as const);
  return [
    ...posts.map((x) => box([x - 0.04, 0, z - 0.02], [x + 0.04, high, z + 0.12], oak)),
    box([left, high - 0.06, z - 0.015], [right, high, z + 0.11], oak),
    ...bays.flatMap(([from, to]) => [
      box([from, 2.02, z + 0.03], [to, 2.08, z + 0.09], oak),
      box([from, 0, z + 0.03], [to, 0.16, z + 0.09], oak),
      box([from, 1.02, z + 0.045], [to, 1.06, z + 0.075], oak),
    ]),
    ...[...Array(9).keys()].map((plank) =>
      box(
        [-3, -0.05, z + 0.13 + 0.2 * plank],
        [3.2, -0.015, z + 0.32 + 0.2 * plank],
        plank % 3 === 1 ? '#9c7a57' : '#a5835f',
      ),
    ),
    ...[-2.85, 3.05].map((x) => box([x - 0.06, -gardenDepth, z + 1.7], [x + 0.06, 2.5, z + 1.82], darkOak)),
    box([-3.1, 2.5, z + 1.68], [3.3, 2.66, z + 1.84], darkOak),
  ];
}

/** Skirting boards along the walls, with a gap at the doors. */
const skirting: readonly Box[] = [
  box([room.from[0], 0, room.from[2]], [room.from[0] + 0.02, 0.11, room.to[2]], painted, '-x-y+y'),
  box([room.to[0] - 0.02, 0, room.from[2]], [room.to[0], 0.11, room.to[2]], painted, '+x-y+y'),
  box([room.from[0], 0, room.from[2]], [room.to[0], 0.11, room.from[2] + 0.02], painted, '-z-y+y'),
  box([room.from[0], 0, room.to[2] - 0.02], [veranda.from[0], 0.11, room.to[2]], painted, '+z-y+y'),
  box([veranda.to[0], 0, room.to[2] - 0.02], [room.to[0], 0.11, room.to[2]], painted, '+z-y+y'),
];

/** Beams below the ceiling, and the lining of the skylight between two of them. */
const overhead: readonly Box[] = [
  ...[-0.55, 1.3, 3.3].map((z) =>
    box([room.from[0], room.to[1] - 0.17, z - 0.07], [room.to[0], room.to[1], z + 0.07], oak, '-x+x+y'),
  ),
  box([0.46, 2.87, 1.51], [0.5, 3.2, 3.09], painted),
  box([1.9, 2.87, 1.51], [1.94, 3.2, 3.09], painted),
  box([0.5, 2.87, 1.51], [1.9, 3.2, 1.55], painted),
  box([0.5, 2.87, 3.05], [1.9, 3.2, 3.09], painted),
  box([1.18, 3.1, 1.55], [1.22, 3.15, 3.05], painted),
];

/** Walls and ceiling go on behind the mirror's wall, for a camera that looks at the user from there. */
const wings: readonly Box[] = [
  box([room.from[0] - 0.2, 0, -3.6], [room.from[0], room.to[1], room.from[2]], plaster, '+z-y+y'),
  box([room.to[0], 0, -3.6], [room.to[0] + 0.2, room.to[1], room.from[2]], plaster, '+z-y+y'),
  box([room.from[0], room.to[1], -3.6], [room.to[0], room.to[1] + 0.2, room.from[2]], lime, '-x+x+z'),
];

/** A bench with cushions below two pictures, at the right wall. */
const bench: readonly Box[] = [
  box([2.62, 0.4, 0.35], [3.05, 0.445, 2.15], oak),
  ...[0.45, 2.0].flatMap((z) => [
    box([2.66, 0, z], [2.71, 0.4, z + 0.05], darkOak, '-y+y'),
    box([2.97, 0, z], [3.02, 0.4, z + 0.05], darkOak, '-y+y'),
  ]),
  box([2.68, 0.13, 0.5], [3.0, 0.155, 2.0], darkOak),
  box([2.65, 0.445, 0.42], [3.03, 0.5, 1.22], linen, '-y'),
  box([2.65, 0.445, 1.28], [3.03, 0.5, 2.08], linen, '-y'),
  box([2.98, 0.5, 0.5], [3.08, 0.82, 0.92], clay, '-y'),
  box([2.98, 0.5, 1.6], [3.08, 0.8, 2.0], indigo, '-y'),
];

/** Pictures: a frame, paper, and a few shapes on it. */
const pictures: readonly Box[] = [
  box([3.07, 1.32, 0.5], [3.1, 2.02, 1.02], darkOak, '+x'),
  box([3.066, 1.35, 0.53], [3.071, 1.99, 0.99], '#f2ecdf', '+x'),
  box([3.063, 1.42, 0.6], [3.067, 1.66, 0.92], clay, '+x'),
  box([3.063, 1.7, 0.66], [3.067, 1.86, 0.82], '#d9a441', '+x'),
  box([3.07, 1.42, 1.3], [3.1, 1.94, 1.98], darkOak, '+x'),
  box([3.066, 1.45, 1.33], [3.071, 1.91, 1.95], '#efe8da', '+x'),
  box([3.063, 1.5, 1.38], [3.067, 1.62, 1.9], '#5d7a5a', '+x'),
  box([3.063, 1.62, 1.5], [3.067, 1.72, 1.9], '#86a07a', '+x'),
  box([3.063, 1.74, 1.42], [3.067, 1.84, 1.52], '#e2b25a', '+x'),
];

/** A woven rug of stripes between the user and the veranda. */
const rugColors = [
  clay,
  linen,
  linen,
  indigo,
  linen,
  linen,
  linen,
  clay,
  linen,
  linen,
  linen,
  indigo,
  linen,
  linen,
  clay,
];
const rug: readonly Box[] = rugColors.map((color, index) =>
  box([-1.15 + 0.16 * index, 0, 2.1], [-0.99 + 0.16 * index, 0.009, 3.6], color, '-x+x-y'),
);

export const plants: readonly Plant[] = [
  { x: 2.58, z: 4.22, height: 1.75, seed: 11 },
  { x: -2.4, z: 4.28, height: 1.25, seed: 5 },
  { x: 2.68, z: -0.95, height: 1.05, seed: 29 },
];

const plantBoxes: readonly (readonly Box[])[] = plants.map(({ x, z, height }) => [
  { from: [x - 0.15, 0, z - 0.15], to: [x + 0.15, 0.34, z + 0.15], color: clay, lightThrough: 0 },
  {
    from: [x - 0.28 * height, 0.42 * height, z - 0.28 * height],
    to: [x + 0.28 * height, height, z + 0.28 * height],
    color: '#4d6b3a',
    lightThrough: 0.6,
  },
]);

/** Everything in the room and before its windows, besides its sides; what stands together is one group. */
export const groups: readonly (readonly Box[])[] = [
  windowFrame(frontWindow),
  windowFrame(sideWindow),
  verandaFrame(veranda),
  skirting,
  overhead,
  wings,
  bench,
  pictures,
  rug,
  ...plantBoxes,
];
