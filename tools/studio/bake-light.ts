import { brightest, layOutLightMap, mapWidth, neutral, type Patch } from '../../src/page/studio/room/light-map';
import { towardsSun } from '../../src/page/studio/room/room-plan';
import { type Light, leave, scatter, skyLight, TracedRoom } from './traced-room';

/**
 * Rays for the light from all sides, along each of two directions of the hemisphere: for each reflection. The last
 * counts most.
 */
const raysAcross = [7, 7, 7, 20];
/** Rays towards the sun, and how far they spread [rad]: soft edges, as of the sun through thin clouds. */
const sunRays = 20;
const sunSpread = 0.011;
/** The light of the sun on a surface that faces it. White paper in the open has 1 from the sky. */
const sun: Light = [3.1, 2.72, 2.14];
/** What a camera in the room would multiply light by, its white balance included. */
const exposure: Light = [2.1, 2.2, 2.38];
/** The share of the light that leaves reflect. */
const foliage: Light = [0.1, 0.16, 0.06];

/** Light at each texel of a patch: red, green, blue, row by row. */
type Field = Float64Array;

const linear = (value: number): number => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
const encoded = (value: number): number => (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);

const reflected = (color: string): Light =>
  [1, 3, 5].map((at) => linear(Number.parseInt(color.slice(at, at + 2), 16) / 255)) as Light;

/** Writes the place of a texel, `inset` from the edges of its patch, where corners would hide it. */
function placeOf(patch: Patch, column: number, row: number, out: Float64Array): void {
  const inset = 0.012;
  const along = (at: number, count: number, edge: readonly number[]) => {
    const least = Math.min(0.5, inset / Math.hypot(...edge));
    return Math.min(1 - least, Math.max(least, at / (count - 1)));
  };
  const s = along(column, patch.columns, patch.u);
  const t = along(row, patch.rows, patch.v);
  for (let i = 0; i < 3; i++)
    out[i] = patch.origin[i]! + s * patch.u[i]! + t * patch.v[i]! + 2 * leave * patch.normal[i]!;
}

/** Returns two unit vectors that are perpendicular to a patch's normal and to each other. */
const tangents = ({ u, v }: Patch) => {
  const unit = (edge: readonly number[]) => edge.map((value) => value / Math.hypot(...edge));
  return [unit(u), unit(v)] as const;
};

/** Averages each texel with its neighbours: rays are few, and light from all sides has no edges. */
function smoothed(field: Field, { columns, rows }: Patch): Field {
  const smooth = new Float64Array(field.length);
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      let weights = 0;
      for (let y = Math.max(0, row - 1); y <= Math.min(rows - 1, row + 1); y++) {
        for (let x = Math.max(0, column - 1); x <= Math.min(columns - 1, column + 1); x++) {
          const weight = (x === column ? 2 : 1) * (y === row ? 2 : 1);
          weights += weight;
          for (let i = 0; i < 3; i++)
            smooth[3 * (row * columns + column) + i]! += weight * field[3 * (y * columns + x) + i]!;
        }
      }
      for (let i = 0; i < 3; i++) smooth[3 * (row * columns + column) + i]! /= weights;
    }
  }
  return smooth;
}

/** Computes the light of the sun, of the sky and of the room's own surfaces, by rays through its windows. */
class LightBake {
  readonly #patches: readonly Patch[];
  readonly #room: TracedRoom;
  readonly #sun: readonly Field[];
  readonly #from = new Float64Array(3);
  readonly #towards = new Float64Array(3);
  readonly #light: Light = [0, 0, 0];
  /** The light at each texel so far. */
  #fields: readonly Field[];

  constructor(patches: readonly Patch[]) {
    this.#patches = patches;
    this.#room = new TracedRoom(patches);
    this.#sun = patches.map((patch, index) => this.#sunOn(patch, index));
    this.#fields = this.#sun;
    for (const across of raysAcross) {
      const gathered = patches.map((patch, index) => this.#gatheredOn(patch, index, across));
      this.#fields = gathered.map((field, index) => field.map((light, i) => light + this.#sun[index]![i]!));
    }
  }

  get fields(): readonly Field[] {
    return this.#fields;
  }

  #sunOn(patch: Patch, index: number): Field {
    const { columns, rows, normal } = patch;
    const field = new Float64Array(3 * columns * rows);
    const facing = normal[0] * towardsSun[0] + normal[1] * towardsSun[1] + normal[2] * towardsSun[2];
    if (facing <= 0) return field;
    for (let texel = 0; texel < columns * rows; texel++) {
      let seen = 0;
      for (let ray = 0; ray < sunRays; ray++) {
        const random = (what: number) => scatter(index * 65536 + texel, ray, what) - 0.5;
        placeOf(patch, (texel % columns) + random(1), Math.floor(texel / columns) + random(2), this.#from);
        for (let i = 0; i < 3; i++) this.#towards[i] = towardsSun[i]! + 2 * sunSpread * random(3 + i);
        if (!this.#room.meet(this.#from, this.#towards, random(7) + 0.5)) seen += 1;
      }
      for (let i = 0; i < 3; i++) field[3 * texel + i] = (sun[i]! * facing * seen) / sunRays;
    }
    return field;
  }

  /** Returns the light from all sides: of the sky, and of what reflects the light so far. */
  #gatheredOn(patch: Patch, index: number, across: number): Field {
    const { columns, rows, normal } = patch;
    const [right, up] = tangents(patch);
    const field = new Float64Array(3 * columns * rows);
    for (let texel = 0; texel < columns * rows; texel++) {
      placeOf(patch, texel % columns, Math.floor(texel / columns), this.#from);
      for (let ray = 0; ray < across ** 2; ray++) {
        const random = (what: number) => scatter(index * 65536 + texel, ray, what);
        const angle = (2 * Math.PI * ((ray % across) + random(11))) / across;
        const height = (Math.floor(ray / across) + random(12)) / across;
        const [out, along] = [Math.sqrt(1 - height), Math.sqrt(height)];
        const [x, y] = [along * Math.cos(angle), along * Math.sin(angle)];
        for (let i = 0; i < 3; i++) this.#towards[i] = out * normal[i]! + x * right[i]! + y * up[i]!;
        this.#seen(random(13));
        for (let i = 0; i < 3; i++) field[3 * texel + i]! += this.#light[i]!;
      }
      for (let i = 0; i < 3; i++) field[3 * texel + i]! /= across ** 2;
    }
    return smoothed(smoothed(field, patch), patch);
  }

  /** Sets the light to what comes from the direction of the ray. */
  #seen(chance: number): void {
    const hit = this.#room.meet(this.#from, this.#towards, chance);
    if (!hit) skyLight(this.#towards[1]!, this.#light);
    else if (hit.patch < 0) for (let i = 0; i < 3; i++) this.#light[i] = 0.4 * foliage[i]!;
    else {
      const { columns, rows, color } = this.#patches[hit.patch]!;
      const texel = Math.round(hit.t * (rows - 1)) * columns + Math.round(hit.s * (columns - 1));
      const share = reflectedOnce(color);
      for (let i = 0; i < 3; i++) this.#light[i] = share[i]! * this.#fields[hit.patch]![3 * texel + i]!;
    }
  }
}

const known = new Map<string, Light>();
function reflectedOnce(color: string): Light {
  const before = known.get(color);
  if (before) return before;
  const share = reflected(color);
  known.set(color, share);
  return share;
}

/** Returns the light map of the room: width, height [texels], and red, green, blue of each, encoded as sRGB. */
export function bakeLight(): { readonly width: number; readonly height: number; readonly pixels: Uint8Array } {
  const { patches, mapHeight } = layOutLightMap();
  const { fields } = new LightBake(patches);
  const pixels = new Uint8Array(3 * mapWidth * mapHeight);
  const write = (x: number, y: number, i: number, light: number) => {
    pixels[3 * (y * mapWidth + x) + i] = Math.round(255 * encoded(Math.min(1, light / brightest)));
  };
  for (let texel = 0; texel < neutral.columns * neutral.rows; texel++) {
    const [x, y] = [texel % neutral.columns, Math.floor(texel / neutral.columns)];
    for (let i = 0; i < 3; i++) write(x, y, i, 1);
  }
  patches.forEach((patch, index) => {
    const { columns, rows, x, y } = patch;
    for (let row = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++) {
        for (let i = 0; i < 3; i++) {
          const light = fields[index]![3 * (row * columns + column) + i]!;
          write(x + column, y + row, i, exposure[i]! * light);
        }
      }
    }
  });
  return { width: mapWidth, height: mapHeight, pixels };
}
