import { type DataTexture, RepeatWrapping } from 'three';
import { createDataTexture } from '../data-texture';
import type { Quality } from '../renderer';

/** Four noises that repeat without a seam: r wide, g fine (both sums of octaves), b grass blades, a one fine octave. */
const side = 256;

/** A number in [0, 1) for a lattice point: the same for the same point. */
function scatter(x: number, y: number, layer: number): number {
  let mixed = Math.imul(x, 0x27d4eb2d) ^ Math.imul(y, 0x165667b1) ^ Math.imul(layer, 0x9e3779b9);
  mixed = Math.imul(mixed ^ (mixed >>> 15), 0x85ebca6b);
  mixed = Math.imul(mixed ^ (mixed >>> 13), 0xc2b2ae35);
  return ((mixed ^ (mixed >>> 16)) >>> 0) / 2 ** 32;
}

/** Value noise with `cells` lattice points along a side, at (u, v) in [0, 1). */
function latticeNoise(u: number, v: number, cells: number, layer: number): number {
  const x = u * cells;
  const y = v * cells;
  const x0 = Math.floor(x);
  const y0 = Math.floor(y);
  const fade = (t: number) => t * t * (3 - 2 * t);
  const a = fade(x - x0);
  const b = fade(y - y0);
  const at = (i: number, j: number) => scatter((x0 + i) % cells, (y0 + j) % cells, layer);
  const low = at(0, 0) + (at(1, 0) - at(0, 0)) * a;
  const high = at(0, 1) + (at(1, 1) - at(0, 1)) * a;
  return low + (high - low) * b;
}

function octaves(u: number, v: number, cells: number, count: number, layer: number): number {
  let sum = 0;
  let weight = 0.5;
  let total = 0;
  for (let octave = 0; octave < count; octave++) {
    sum += weight * latticeNoise(u, v, cells * 2 ** octave, layer + octave);
    total += weight;
    weight /= 2;
  }
  return sum / total;
}

/**
 * Short strokes, each a blade with its own brightness, in [0, 1]; they cross the edges and come in again on the other
 * side.
 */
function grassBlades(): Float32Array {
  const blades = new Float32Array(side * side).fill(0.42);
  const count = 5200;
  for (let blade = 0; blade < count; blade++) {
    const random = (what: number) => scatter(blade, what, 77);
    const brightness = 0.15 + 0.85 * random(0);
    const length = 7 + 15 * random(1);
    const angle = -Math.PI / 2 + (random(2) - 0.5) * 2.1;
    const x0 = random(3) * side;
    const y0 = random(4) * side;
    for (let step = 0; step < length; step++) {
      const along = step / length;
      const x = Math.floor(x0 + Math.cos(angle + 0.5 * along) * step) & (side - 1);
      const y = Math.floor(y0 + Math.sin(angle + 0.5 * along) * step) & (side - 1);
      const at = y * side + x;
      const shade = brightness * (0.55 + 0.45 * along);
      blades[at] = (blades[at] as number) * 0.25 + shade * 0.75;
    }
  }
  return blades;
}

/** Built once for both ground and clouds; linear values, not colours. */
export function createNoiseTexture(quality: Quality): DataTexture {
  const pixels = new Uint8Array(side * side * 4);
  const blades = grassBlades();
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      const u = x / side;
      const v = y / side;
      const at = (y * side + x) * 4;
      pixels[at] = 255 * octaves(u, v, 4, 5, 11);
      pixels[at + 1] = 255 * octaves(u, v, 16, 4, 23);
      pixels[at + 2] = 255 * (blades[y * side + x] as number);
      pixels[at + 3] = 255 * latticeNoise(u, v, 64, 41);
    }
  }
  const texture = createDataTexture(pixels, side, quality);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  return texture;
}
