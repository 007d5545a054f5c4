import { BoxGeometry, type BufferGeometry, Color, Float32BufferAttribute } from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';

/**
 * Gives every vertex one colour, or a colour by its position; the geometry loses its index and texture coordinates so
 * that any two can be merged.
 */
export function painted(
  geometry: BufferGeometry,
  color: string | ((x: number, y: number, z: number, paint: Color) => void),
): BufferGeometry {
  const flat = geometry.index ? geometry.toNonIndexed() : geometry;
  flat.deleteAttribute('uv');
  const position = flat.getAttribute('position');
  const colors = new Float32Array(position.count * 3);
  const paint = new Color();
  if (typeof color === 'string') paint.set(color);
  for (let i = 0; i < position.count; i++) {
    if (typeof color === 'function') color(position.getX(i), position.getY(i), position.getZ(i), paint);
    paint.toArray(colors, i * 3);
  }
  flat.setAttribute('color', new Float32BufferAttribute(colors, 3));
  return flat;
}

/** Creates a box of one colour; `size`: width, height and depth, `middle`: where it is [m]. */
export const paintedBox = (
  [width, height, depth]: readonly [number, number, number],
  [x, y, z]: readonly [number, number, number],
  color: string,
): BufferGeometry => painted(new BoxGeometry(width, height, depth).translate(x, y, z), color);

/** Merges geometries into one, and disposes them. */
export function merged(geometries: readonly BufferGeometry[]): BufferGeometry {
  const whole = mergeGeometries([...geometries]);
  for (const geometry of geometries) geometry.dispose();
  return whole;
}
