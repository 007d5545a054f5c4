import {
  BufferGeometry,
  Color,
  DataTexture,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
  SRGBColorSpace,
  type Texture,
  TextureLoader,
} from 'three';
import { clamp } from 'threepoint/math';
import { merged, painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';
import { brightest, layOutLightMap, mapWidth, type Patch } from './light-map';
import { createPlanks, plankTile } from './planks';
import { plantGeometry } from './plant';
import { plants } from './room-plan';

/** How far a side of the room reaches beyond its corners [m], so that no sky shines through them. */
const overlap = 0.01;
/** How far the floor reaches beyond the wall with the mirror [m], where a camera may stand. */
const floorBehindMirror = 4;

/** Returns the lines that divide an edge of a patch: its ends, about 0 and 1, and the edges of its openings. */
function cuts({ side, origin }: Patch, edge: Patch['u']): number[] {
  const axis = edge.findIndex((length) => length !== 0);
  const length = edge[axis]!;
  const ends = side?.openings.flatMap(({ from, to }) => [from[axis]!, to[axis]!]) ?? [];
  const beyond = side ? overlap / length : 0;
  const before = side?.name === 'floor' && axis === 2 ? floorBehindMirror / length : beyond;
  const shares = [-before, ...ends.map((at) => (at - origin[axis]!) / length), 1 + beyond];
  return [...new Set(shares)].sort((a, b) => a - b);
}

/** Returns a point of a patch [m]; `s`, `t`: 0 to 1. */
const pointOf = ({ origin, u, v }: Patch, s: number, t: number) =>
  origin.map((from, i) => from + s * u[i]! + t * v[i]!) as [number, number, number];

function isOpen(patch: Patch, s: number, t: number): boolean {
  const at = pointOf(patch, s, t);
  const { axis, openings } = patch.side ?? { axis: 0, openings: [] };
  return openings.some(({ from, to }) => at.every((value, i) => i === axis || (value > from[i]! && value < to[i]!)));
}

/** Returns the place of a point of a patch in the light map: its first and last texels lie on its edges. */
const lightAt = ({ x, y, columns, rows }: Patch, s: number, t: number, mapHeight: number) =>
  [(x + 0.5 + clamp(s, 0, 1) * (columns - 1)) / mapWidth, (y + 0.5 + clamp(t, 0, 1) * (rows - 1)) / mapHeight] as const;

/**
 * Builds a patch of the room. It is divided along the edges of its openings, so that no corner lies on the edge of
 * another rectangle, where sky would shine through.
 */
function patchGeometry(patch: Patch, mapHeight: number): BufferGeometry {
  const [positions, colors, places, lights]: number[][] = [[], [], [], []];
  const color = new Color(patch.color).toArray();
  const [across, up] = [cuts(patch, patch.u), cuts(patch, patch.v)];
  for (let i = 0; i + 1 < across.length; i++) {
    for (let j = 0; j + 1 < up.length; j++) {
      const [s0, s1, t0, t1] = [across[i]!, across[i + 1]!, up[j]!, up[j + 1]!];
      if (isOpen(patch, (s0 + s1) / 2, (t0 + t1) / 2)) continue;
      for (const [s, t] of [
        [s0, t0],
        [s1, t0],
        [s1, t1],
        [s0, t0],
        [s1, t1],
        [s0, t1],
      ] as const) {
        const at = pointOf(patch, s, t);
        positions!.push(...at);
        colors!.push(...color);
        places!.push(at[0] / plankTile.across, at[2] / plankTile.along);
        lights!.push(...lightAt(patch, s, t, mapHeight));
      }
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions!, 3));
  geometry.setAttribute('color', new Float32BufferAttribute(colors!, 3));
  geometry.setAttribute('uv', new Float32BufferAttribute(places!, 2));
  geometry.setAttribute('uv1', new Float32BufferAttribute(lights!, 2));
  return geometry;
}

/** Gives geometry that is painted with its light the texels of the map whose light is 1. */
function inOwnLight(geometry: BufferGeometry, mapHeight: number): BufferGeometry {
  const { count } = geometry.getAttribute('position');
  const neutral = new Array(count).fill([1 / mapWidth, 1 / mapHeight]).flat();
  geometry.setAttribute('uv', new Float32BufferAttribute(new Array(2 * count).fill(0), 2));
  geometry.setAttribute('uv1', new Float32BufferAttribute(neutral, 2));
  return geometry;
}

/** Returns a flat ring or star of the inlay that marks where to stand, pointing towards the mirror. */
const inlaid = (inner: number, outer: number, corners: number, color: string) =>
  painted(new RingGeometry(inner, outer, corners, 1, Math.PI / 2).rotateX(-Math.PI / 2), color);

/** Builds an inlay of dark wood and brass in the floor, where the user stands. */
function inlayGeometry(floor: Patch, mapHeight: number): BufferGeometry {
  const tip = inlaid(0, 0.05, 3, '#c79f5c').scale(1, 1, 1.5).translate(0, 0, -0.37);
  const geometry = merged([inlaid(0.37, 0.4, 72, '#5d3c24'), inlaid(0.355, 0.37, 72, '#c79f5c'), tip]);
  geometry.translate(0, 0.002, 0).deleteAttribute('normal');
  const { origin, u, v } = floor;
  const position = geometry.getAttribute('position');
  const lights: number[] = [];
  for (let i = 0; i < position.count; i++) {
    const [x, z] = [position.getX(i) - origin[0], position.getZ(i) - origin[2]];
    const share = (edge: Patch['u']) => (x * edge[0] + z * edge[2]) / (edge[0] ** 2 + edge[2] ** 2);
    lights.push(...lightAt(floor, share(u), share(v), mapHeight));
  }
  geometry.setAttribute('uv', new Float32BufferAttribute(new Array(2 * position.count).fill(0), 2));
  geometry.setAttribute('uv1', new Float32BufferAttribute(lights, 2));
  return geometry;
}

/** Returns a texture of light: its colours, and which texture coordinates have its places. */
function asLight<Light extends Texture>(texture: Light): Light {
  texture.colorSpace = SRGBColorSpace;
  texture.channel = 1;
  return texture;
}

/** Returns the light until the map has arrived: about what the map has on average. */
function evenLight(): Texture {
  const texture = asLight(new DataTexture(new Uint8Array([150, 146, 138, 255]), 1, 1));
  texture.needsUpdate = true;
  return texture;
}

/**
 * Builds the room of the studio; floor frame. Its light comes from a map, which arrives later; until then it is lit
 * evenly.
 */
export function createRoom(quality: Quality): Group {
  const { patches, mapHeight } = layOutLightMap();
  const lightMap = evenLight();
  const light = { lightMap, lightMapIntensity: Math.PI * brightest, fog: false };
  const floor = new MeshBasicMaterial({ ...light, map: createPlanks(quality) });
  const rest = new MeshBasicMaterial({ ...light, vertexColors: true });
  const isFloor = ({ side }: Patch) => side?.name === 'floor';
  const built = (which: readonly Patch[]) => which.map((patch) => patchGeometry(patch, mapHeight));
  const things = [
    ...built(patches.filter((patch) => !isFloor(patch))),
    inlayGeometry(patches.find(isFloor)!, mapHeight),
    ...plants.map((plant) => inOwnLight(plantGeometry(plant), mapHeight)),
  ];
  const room = new Group();
  room.name = 'studio room';
  room.add(new Mesh(merged(built(patches.filter(isFloor))), floor), new Mesh(merged(things), rest));
  new TextureLoader().load(new URL('./light-map.png', import.meta.url).href, (map) => {
    map.flipY = false;
    map.generateMipmaps = false;
    map.minFilter = map.magFilter;
    floor.lightMap = rest.lightMap = asLight(map);
    lightMap.dispose();
  });
  return room;
}
