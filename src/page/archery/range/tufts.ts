import {
  BufferGeometry,
  Color,
  Float32BufferAttribute,
  InstancedMesh,
  Matrix4,
  MeshLambertMaterial,
  Quaternion,
  Vector3,
} from 'three';
import { walls } from 'threepoint-games/archery';
import { createRandomRange } from '../../scene/random-range';
import { field } from './field';

/** A few blades that lean apart; they are lit like the ground they grow from. */
function tuftGeometry(): BufferGeometry {
  const random = createRandomRange(97);
  const positions: number[] = [];
  const normals: number[] = [];
  const colors: number[] = [];
  const foot = new Color('#6f8f40');
  const tip = new Color('#b3c16a');
  for (let blade = 0; blade < 6; blade++) {
    const turn = (blade / 6) * 2 * Math.PI + random(-0.4, 0.4);
    const height = random(0.07, 0.16);
    const lean = random(0.02, 0.09);
    const across = { x: Math.cos(turn) * 0.008, z: Math.sin(turn) * 0.008 };
    const out = { x: -Math.sin(turn), z: Math.cos(turn) };
    const root = random(0, 0.03);
    const corner = (end: number) => {
      positions.push(out.x * root + end * across.x, 0, out.z * root + end * across.z);
      colors.push(...foot.toArray());
    };
    // Both sides by two triangles: a double-sided material would turn the normals down on one of them.
    for (const side of [-1, 1]) {
      corner(-side);
      corner(side);
      positions.push(out.x * (root + lean), height, out.z * (root + lean));
      colors.push(...tip.toArray());
      for (let i = 0; i < 3; i++) normals.push(0, 1, 0);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new Float32BufferAttribute(normals, 3));
  geometry.setAttribute('color', new Float32BufferAttribute(colors, 3));
  return geometry;
}

/** Long grass where no mower comes: along ropes and nets, and scattered over the meadow. Arena frame. */
export function createTufts(): InstancedMesh {
  const random = createRandomRange(4177);
  const spots: { readonly x: number; readonly z: number; readonly size: number }[] = [];
  const near = Math.max(...walls.filter(({ axis }) => axis === 'z').map(({ at }) => at));
  const side = Math.max(...walls.filter(({ axis }) => axis === 'x').map(({ at }) => at));
  for (const sign of [-1, 1]) {
    for (let i = 0; i < 520; i++) {
      const z = random(field.far, 2.2);
      spots.push({
        x: sign * (field.halfWidth + 0.12 + Math.abs(random(-1, 1) * random(0, 0.5))),
        z,
        size: random(0.5, 1.1),
      });
    }
    for (let i = 0; i < 330; i++) {
      spots.push({ x: sign * (side + random(-0.12, 0.3)), z: random(field.back, near), size: random(0.7, 1.5) });
    }
    for (let i = 0; i < 420; i++) {
      spots.push({
        x: sign * random(field.halfWidth + 0.2, 11),
        z: random(field.back, near + 3),
        size: random(0.5, 1.2),
      });
    }
  }
  for (let i = 0; i < 420; i++) {
    spots.push({ x: random(-side, side), z: field.back + random(-0.35, 0.1), size: random(0.6, 1.4) });
  }
  const tufts = new InstancedMesh(tuftGeometry(), new MeshLambertMaterial({ vertexColors: true }), spots.length);
  tufts.name = 'tufts';
  tufts.receiveShadow = true;
  const matrix = new Matrix4();
  const turn = new Quaternion();
  const up = new Vector3(0, 1, 0);
  for (const [index, { x, z, size }] of spots.entries()) {
    turn.setFromAxisAngle(up, random(0, 2 * Math.PI));
    tufts.setMatrixAt(index, matrix.compose(new Vector3(x, 0, z), turn, new Vector3(size, size, size)));
  }
  return tufts;
}
