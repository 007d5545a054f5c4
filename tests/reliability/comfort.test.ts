import { readFileSync } from 'node:fs';
import { PerspectiveCamera } from 'three';
import { createMirror } from 'threepoint/avatar/mirror';
import { identity } from 'threepoint/core/math/quat';
import { vec3 } from 'threepoint/core/math/vec3';
import { createVignette } from 'threepoint-page/scene/vignette';
import { expect, test } from 'vitest';
import { measured } from './measured';

const css = readFileSync(new URL('../../src/ui/styles/page/base.css', import.meta.url), 'utf8');

/** A colour of the page's root, as shares of red, green and blue. */
function colour(name: string): readonly number[] {
  const hex = new RegExp(`--${name}: #([0-9a-f]{6})`).exec(css)?.[1];
  const rgb = new RegExp(`--${name}: rgb\\((\\d+) (\\d+) (\\d+)`).exec(css);
  if (hex) return [0, 2, 4].map((at) => Number.parseInt(hex.slice(at, at + 2), 16) / 255);
  if (rgb) return rgb.slice(1, 4).map((value) => Number(value) / 255);
  throw new Error(`base.css has no colour --${name}`);
}

/** Relative luminance as WCAG defines it. */
const luminance = (rgb: readonly number[]): number => {
  const [r = 0, g = 0, b = 0] = rgb.map((value) =>
    value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4,
  );
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const contrast = (a: readonly number[], b: readonly number[]): number => {
  const [dark = 0, light = 0] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (light + 0.05) / (dark + 0.05);
};

test('text stands out from what it is written on, for every kind of colour vision', () => {
  const least = Math.min(
    contrast(colour('ink'), colour('glass')),
    contrast(colour('ink-soft'), colour('glass')),
    contrast(colour('accent-ink'), colour('accent')),
    contrast(colour('trouble'), colour('glass')),
  );
  expect(least).toBeGreaterThan(4.5);
  measured('comfort', { 'least contrast of text': `${least.toFixed(1)} : 1`, 'larger text': '130 %, remembered' });
});

test('the edges are dark at a turn and clear again in under half a second, round the eyes wherever they are', () => {
  const vignette = createVignette();
  const eyes = { position: vec3(1, 1.6, 2), orientation: identity };
  vignette.show(0, eyes);
  expect(vignette.object.visible).toBe(false);
  vignette.close(10);
  vignette.show(10, eyes);
  expect(vignette.darkness).toBe(1);
  expect(vignette.object.visible).toBe(true);
  expect(vignette.object.position.x).toBe(1);
  vignette.show(10.2, eyes);
  expect(vignette.darkness).toBeGreaterThan(0.2);
  vignette.show(10.2, null);
  expect(vignette.object.visible).toBe(false);
  vignette.show(10.5, eyes);
  expect(vignette.darkness).toBe(0);
  vignette.dispose();
});

test('the dark edges are before the eyes alone: a mirror shows no black ball for a head', () => {
  const { object } = createVignette();
  const glass = createMirror().object.children.find((child) => 'getReflectionCamera' in child) as unknown as {
    getReflectionCamera(eye: PerspectiveCamera): PerspectiveCamera;
  };
  for (const layer of [1, 2]) {
    // As WebXRManager makes it: all see layer 0, one eye this one.
    const eye = new PerspectiveCamera();
    eye.layers.enable(layer);
    expect(object.layers.test(eye.layers)).toBe(true);
    const reflecting = glass.getReflectionCamera(eye);
    expect(object.layers.test(reflecting.layers)).toBe(false);
    expect(reflecting.layers.isEnabled(0)).toBe(true);
  }
  expect(object.layers.test(new PerspectiveCamera().layers)).toBe(false);
});
