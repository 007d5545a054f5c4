import {
  type BufferGeometry,
  CatmullRomCurve3,
  Color,
  CylinderGeometry,
  DataTexture,
  Group,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  MeshLambertMaterial,
  PlaneGeometry,
  RepeatWrapping,
  SphereGeometry,
  TubeGeometry,
  Vector3,
} from 'three';
import { merged, painted } from '../../scene/painted-geometry';
import { field } from './field';
import { woodColor } from './wood';

/** One mesh of a net: cords along two edges of a square that repeats; far away it becomes an even veil. */
function netTexture(): DataTexture {
  const side = 32;
  const pixels = new Uint8Array(side * side * 4);
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      const fromCord = Math.min(x, y);
      const at = (y * side + x) * 4;
      pixels.fill(255, at, at + 3);
      pixels[at + 3] = fromCord < 3 ? 215 : 0;
    }
  }
  const texture = new DataTexture(pixels, side, side);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 8;
  texture.needsUpdate = true;
  return texture;
}

/** A net between posts; arrows that miss end in it. */
function createNet(): Mesh {
  const { halfWidth, height, z } = field.net;
  const texture = netTexture();
  texture.repeat.set(halfWidth * 2 * 9, height * 9);
  const net = new Mesh(
    new PlaneGeometry(2 * halfWidth, height - 0.15).translate(0, height / 2, z),
    new MeshLambertMaterial({
      map: texture,
      color: '#22322b',
      transparent: true,
      opacity: 0.8,
      depthWrite: false,
      side: 2,
    }),
  );
  net.name = 'net';
  return net;
}

/** A grassy bank behind the net. */
function bank(): BufferGeometry {
  const geometry = new SphereGeometry(1, 48, 14, 0, 2 * Math.PI, 0, Math.PI / 2).scale(8.5, 1.75, 2.6);
  const position = geometry.getAttribute('position');
  for (let i = 0; i < position.count; i++) {
    const x = position.getX(i);
    const y = position.getY(i);
    position.setY(i, y * (0.9 + 0.09 * Math.sin(2.3 * x) + 0.05 * Math.sin(5.1 * x + 1)));
  }
  geometry.computeVertexNormals();
  const low = new Color('#5c7f38');
  const high = new Color('#86a552');
  return painted(geometry.translate(0, -0.04, field.net.z - 3.3), (_x, y, _z, paint) => {
    paint.copy(low).lerp(high, Math.max(0, Math.min(1, y / 1.6)));
  });
}

/** A rope that sags a little between two points. */
function rope(from: Vector3, to: Vector3, sag: number, radius: number): BufferGeometry {
  const middle = from.clone().lerp(to, 0.5);
  middle.y -= sag;
  return painted(new TubeGeometry(new CatmullRomCurve3([from, middle, to]), 10, radius, 5), '#e9dfc4');
}

const post = (x: number, z: number, height: number, radius: number) =>
  merged([
    painted(new CylinderGeometry(radius, radius * 1.08, height, 10).translate(x, height / 2, z), woodColor(x + z)),
    painted(new CylinderGeometry(radius * 1.05, radius * 1.05, 0.03, 10).translate(x, height + 0.01, z), '#e8e2d2'),
  ]);

function ropesAndPosts(): BufferGeometry {
  const parts: BufferGeometry[] = [];
  const stations = [1.6, -1.9, -5.4, -8.9, -12.2];
  for (const side of [-1, 1]) {
    const x = side * field.halfWidth;
    stations.forEach((z, i) => {
      parts.push(post(x, z, 0.86, 0.035));
      const next = stations[i + 1];
      if (next !== undefined) {
        parts.push(rope(new Vector3(x, 0.79, z), new Vector3(x, 0.79, next), 0.13, 0.013));
      }
    });
  }
  const { halfWidth, height, z } = field.net;
  for (let i = 0; i <= 4; i++) {
    const x = -halfWidth + (i * halfWidth) / 2;
    parts.push(post(x, z - 0.08, height, 0.05));
    if (i < 4) {
      const next = x + halfWidth / 2;
      parts.push(
        rope(new Vector3(x, height - 0.06, z - 0.02), new Vector3(next, height - 0.06, z - 0.02), 0.04, 0.012),
      );
      parts.push(rope(new Vector3(x, 0.1, z - 0.02), new Vector3(next, 0.1, z - 0.02), 0.02, 0.01));
    }
  }
  return merged(parts);
}

/** What keeps arrows and people where they belong: bank, net, posts and ropes. Arena frame. */
export function createBackstop(): Group {
  const backstop = new Group();
  backstop.name = 'backstop';
  const solid = new Mesh(merged([bank(), ropesAndPosts()]), new MeshLambertMaterial({ vertexColors: true }));
  solid.receiveShadow = true;
  backstop.add(solid, createNet());
  return backstop;
}
