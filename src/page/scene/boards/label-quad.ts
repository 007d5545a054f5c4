import { PlaneGeometry } from 'three';

/** Creates a quad that faces +Z about the origin, with one row of a texture that has `rows` of them, from the top. */
export function createLabelQuad(width: number, height: number, row: number, rows: number): PlaneGeometry {
  const quad = new PlaneGeometry(width, height);
  const uv = quad.getAttribute('uv');
  for (let i = 0; i < uv.count; i++) uv.setY(i, 1 - (row + 1 - uv.getY(i)) / rows);
  return quad;
}
