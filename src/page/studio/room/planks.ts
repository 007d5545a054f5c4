import { RepeatWrapping, SRGBColorSpace, type Texture } from 'three';
import { createRandom } from 'threepoint/math';
import { createDataTexture } from '../../scene/data-texture';
import type { Quality } from '../../scene/renderer';

/** The floor that the texture shows before it repeats [m]: across the boards, and along them. */
export const plankTile = { across: 1.92, along: 3.2 } as const;

const boards = 12;
/** The tones of oiled oak: red, green, blue. */
const dark = [157, 117, 79] as const;
const light = [219, 182, 139] as const;

/** Returns smooth noise of a period of `count` random numbers, at a position of [0, count). */
function smoothNoise(count: number, random: () => number): (at: number) => number {
  const values = Array.from({ length: count }, random);
  return (at) => {
    const whole = Math.floor(at);
    const part = at - whole;
    const [before, after] = [values[whole % count]!, values[(whole + 1) % count]!];
    return before + (after - before) * part * part * (3 - 2 * part);
  };
}

/** Creates the picture of a floor of oak boards with their grain, knots and joints; it repeats without a seam. */
export function createPlanks(quality: Quality): Texture {
  const side = quality === 'high' ? 1024 : 512;
  const pixels = new Uint8Array(side * side * 4);
  const random = createRandom(4711);
  const width = side / boards;
  for (let board = 0; board < boards; board++) {
    const tone = 0.25 + 0.5 * random();
    const joint = random();
    const wander = smoothNoise(9, random);
    const fibre = smoothNoise(64, random);
    const pores = smoothNoise(997, random);
    const wave = smoothNoise(23, random);
    for (let y = 0; y < side; y++) {
      const along = y / side;
      const bend = 2.6 * wander(along * 9) + 0.35 * wave(along * 23);
      const pore = 331 * along * 0.37 + 40 * fibre(along * 64);
      const fromJoint = Math.abs(((along - joint + 1.5) % 1) - 0.5) * side;
      for (let x = Math.ceil(board * width); x < (board + 1) * width; x++) {
        const across = x / width - board;
        const rings = fibre((across * 7 + bend) % 64);
        const fine = pores((across * 90 + pore) % 997);
        const edge = Math.min(across, 1 - across) * width;
        const groove = Math.min(1, (0.35 + edge) / 1.5, (0.35 + fromJoint) / 1.5);
        const share = Math.min(1, Math.max(0, tone + 0.34 * (rings - 0.5) + 0.22 * (fine - 0.5)));
        const at = (y * side + x) * 4;
        for (let i = 0; i < 3; i++)
          pixels[at + i] = (dark[i]! + (light[i]! - dark[i]!) * share) * (0.45 + 0.55 * groove);
        pixels[at + 3] = 255;
      }
    }
  }
  const texture = createDataTexture(pixels, side, quality);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  return texture;
}
