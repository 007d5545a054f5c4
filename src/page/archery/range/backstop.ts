import {
  type BufferGeometry,
  CatmullRomCurve3,
  Color,
  CylinderGeometry,
  type DataTexture,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  RepeatWrapping,
  SphereGeometry,
  TubeGeometry,
  Vector3,
} from 'three';
import { clamp } from 'threepoint/math';
import { walls } from 'threepoint-games/archery';
import { createDataTexture } from '../../scene/data-texture';
import { doubleSided } from '../../scene/double-sided';
import { woodColor } from '../../scene/outdoors/wood-color';
import { merged, painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';
import { field } from './field';

/** One mesh of a net: cords along two edges of a square that repeats; far away it becomes an even veil. */
function netTexture(quality: Quality): DataTexture {
  const side = 32;
  const pixels = new Uint8Array(side * side * 4);
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      const fromCord = Math.min(x, y);
      const at = (y * side + x) * 4;
      pixels.fill(255, at, at + 3);
      pixels[at + 3] = fromCord < 3 ? 225 : 0;
    }
  }
  const texture = createDataTexture(pixels, side, quality);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  return texture;
}

/** The distance between two cords [m]. */
const cordSpacing = 0.11;

/**
 * A net from the ground up; arrows that miss end in it. Its ends, width and height are those of the wall that the rules
 * know.
 */
function createNets(quality: Quality): Group {
  const texture = netTexture(quality);
  const nets = new Group();
  for (const wall of walls) {
    // The net behind the archer is hardly ever hit: only its posts are drawn.
    if (wall.axis === 'z' && wall.at > 0) continue;
    const [from, to] = wall.axis === 'z' ? span('x') : span('z');
    const length = to - from;
    const geometry = new PlaneGeometry(length, wall.height - netLift);
    const uv = geometry.getAttribute('uv');
    for (let i = 0; i < uv.count; i++) {
      uv.setXY(i, (uv.getX(i) * length) / cordSpacing, (uv.getY(i) * wall.height) / cordSpacing);
    }
    geometry.translate((from + to) / 2, (wall.height + netLift) / 2, 0);
    if (wall.axis === 'x') geometry.rotateY(-Math.PI / 2);
    geometry.translate(wall.axis === 'x' ? wall.at : 0, 0, wall.axis === 'z' ? wall.at : 0);
    const material = new MeshBasicMaterial({
      map: texture,
      color: wall.axis === 'z' ? '#2b3d33' : '#5d7566',
      transparent: true,
      opacity: wall.axis === 'z' ? 0.75 : 0.34,
      depthWrite: false,
      ...doubleSided,
    });
    nets.add(new Mesh(geometry, material));
  }
  nets.name = 'nets';
  return nets;
}

const netLift = 0.06;

/** Returns the limits of the range along an axis. */
function span(axis: 'x' | 'z'): readonly [number, number] {
  const ends = walls.filter((wall) => wall.axis === axis).map(({ at }) => at);
  return [Math.min(...ends), Math.max(...ends)];
}

/** A grassy bank behind the net. */
function bank(): BufferGeometry {
  const geometry = new SphereGeometry(1, 48, 14, 0, 2 * Math.PI, 0, Math.PI / 2).scale(8.5, 1.9, 2.6);
  const position = geometry.getAttribute('position');
  for (let i = 0; i < position.count; i++) {
    const x = position.getX(i);
    const y = position.getY(i);
    position.setY(i, y * (0.9 + 0.09 * Math.sin(2.3 * x) + 0.05 * Math.sin(5.1 * x + 1)));
  }
  geometry.computeVertexNormals();
  const low = new Color('#5c7f38');
  const high = new Color('#86a552');
  return painted(geometry.translate(0, -0.04, field.back - 3.5), (_x, y, _z, paint) => {
    paint.copy(low).lerp(high, clamp(y / 1.6, 0, 1));
  });
}

/** A rope that sags a little between two points. */
function rope(from: Vector3, to: Vector3, sag: number, radius: number, quality: Quality): BufferGeometry {
  const middle = from.clone().lerp(to, 0.5);
  middle.y -= sag;
  return painted(
    new TubeGeometry(
      new CatmullRomCurve3([from, middle, to]),
      quality === 'high' ? 10 : 5,
      radius,
      quality === 'high' ? 5 : 3,
    ),
    '#e9dfc4',
  );
}

const post = (x: number, z: number, height: number, radius: number, sides: number) =>
  merged([
    painted(new CylinderGeometry(radius, radius * 1.08, height, sides).translate(x, height / 2, z), woodColor(x + z)),
    painted(new CylinderGeometry(radius * 1.05, radius * 1.05, 0.03, sides).translate(x, height + 0.01, z), '#e8e2d2'),
  ]);

function ropesAndPosts(quality: Quality): BufferGeometry {
  const parts: BufferGeometry[] = [];
  const sides = quality === 'high' ? 10 : 6;
  const stations = [1.6, -2.2, -6, -9.8, -13.4];
  for (const side of [-1, 1]) {
    const x = side * field.halfWidth;
    stations.forEach((z, i) => {
      parts.push(post(x, z, 0.86, 0.035, sides));
      const next = stations[i + 1];
      if (next !== undefined) {
        parts.push(rope(new Vector3(x, 0.79, z), new Vector3(x, 0.79, next), 0.13, 0.013, quality));
      }
    });
  }
  for (const { axis, at, height } of walls) {
    const [from, to] = axis === 'z' ? span('x') : span('z');
    const count = axis === 'z' ? 4 : 6;
    const place = (i: number, y: number) => {
      const along = from + ((to - from) * i) / count;
      return axis === 'z' ? new Vector3(along, y, at) : new Vector3(at, y, along);
    };
    for (let i = 0; i <= count; i++) {
      const foot = place(i, 0);
      // Corners belong to both walls; one of them plants their posts.
      if (axis === 'z' || (i > 0 && i < count)) parts.push(post(foot.x, foot.z, height + 0.05, 0.045, sides));
      if (i === count) continue;
      parts.push(rope(place(i, height - 0.03), place(i + 1, height - 0.03), 0.05, 0.012, quality));
      if (axis === 'z' && at > 0) continue;
      parts.push(rope(place(i, netLift), place(i + 1, netLift), 0.015, 0.009, quality));
    }
  }
  return merged(parts);
}

/** Creates the bank, nets, posts and ropes around the range; arena frame. */
export function createBackstop(quality: Quality): Group {
  const backstop = new Group();
  backstop.name = 'backstop';
  const solid = new Mesh(merged([bank(), ropesAndPosts(quality)]), new MeshLambertMaterial({ vertexColors: true }));
  solid.receiveShadow = true;
  backstop.add(solid, createNets(quality));
  return backstop;
}
