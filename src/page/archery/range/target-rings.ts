import { Color, type DataTexture, SRGBColorSpace } from 'three';
import { createDataTexture } from '../../scene/data-texture';
import type { Quality } from '../../scene/renderer';

/**
 * The rings of a target from the outside in, each as a share of its radius. Neighbours differ in brightness as well as
 * hue, and a thin line separates them, so that they remain distinct with any colour blindness and in greyscale.
 */
export const rings = [
  { from: 0.8, color: '#f6f2e6' },
  { from: 0.6, color: '#1b2836' },
  { from: 0.4, color: '#86c8ee' },
  { from: 0.2, color: '#a8380f' },
  { from: 0, color: '#ffd84a' },
] as const;

const lineColor = '#f6f2e6';
const darkLineColor = '#1b2836';
const lineShare = 0.011;

/** The colour at a share of the radius, in [0, 1]; beyond the edge: that of the outermost ring. */
export function ringColor(share: number): string {
  if (share < 0.035 && share > 0.018) return darkLineColor;
  for (const { from, color } of rings) {
    if (from > 0 && Math.abs(share - from) < lineShare / 2) return from === 0.8 ? darkLineColor : lineColor;
    if (share >= from) return color;
  }
  return lineColor;
}

const side = 512;
const samples = 3;

/** The face of a target, its square filled by the disc. */
export function createRingTexture(quality: Quality): DataTexture {
  const pixels = new Uint8Array(side * side * 4);
  const paint = new Color();
  const table = Array.from({ length: 2048 }, (_, i) =>
    paint.set(ringColor(i / 2047)).getRGB({ r: 0, g: 0, b: 0 }, SRGBColorSpace),
  );
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      let red = 0;
      let green = 0;
      let blue = 0;
      for (let sample = 0; sample < samples * samples; sample++) {
        const u = (x + ((sample % samples) + 0.5) / samples) / side - 0.5;
        const v = (y + (Math.floor(sample / samples) + 0.5) / samples) / side - 0.5;
        const color = table[Math.min(2047, Math.round(Math.hypot(u, v) * 2 * 2047))] as {
          r: number;
          g: number;
          b: number;
        };
        red += color.r;
        green += color.g;
        blue += color.b;
      }
      const at = (y * side + x) * 4;
      const scale = 255 / (samples * samples);
      pixels.set([red * scale, green * scale, blue * scale, 255], at);
    }
  }
  const texture = createDataTexture(pixels, side, quality);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}
