import {
  BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  DynamicDrawUsage,
  Float32BufferAttribute,
  InstancedMesh,
  Matrix4,
  MeshLambertMaterial,
  Quaternion,
  Vector3,
} from 'three';
import type { Arrow } from 'threepoint-games/archery';
import { merged, painted } from '../../scene/painted-geometry';
import { type ArrowPose, arrowPose, makeArrowPose } from './arrow-pose';

/** The largest number of drawn arrows; the oldest ones are left out. */
const capacity = 64;
const shaftRadius = 0.0042;

/** A vane: a curved blade along the shaft, seen from both sides. */
function vane(turn: number, length: number, color: string): BufferGeometry {
  const start = length - 0.145;
  const outline = [
    [start, 0],
    [start + 0.03, 0.014],
    [start + 0.075, 0.024],
    [start + 0.112, 0.026],
    [start + 0.118, 0.02],
    [start + 0.118, 0],
  ] as const;
  const positions: number[] = [];
  const point = (i: number) => {
    const [z, out] = outline[i] as readonly [number, number];
    const radius = shaftRadius * 0.9 + out;
    positions.push(Math.sin(turn) * radius, Math.cos(turn) * radius, z);
  };
  for (let i = 1; i + 1 < outline.length; i++) {
    point(0);
    point(i);
    point(i + 1);
    point(0);
    point(i + 1);
    point(i);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
  geometry.computeVertexNormals();
  return painted(geometry, color);
}

/** Tip at the origin, pointing along −Z, nock at z = length. */
export function arrowGeometry(length: number): BufferGeometry {
  const along = (geometry: BufferGeometry, z: number) => geometry.rotateX(Math.PI / 2).translate(0, 0, z);
  const rod = (from: number, to: number, radius: number, color: string) =>
    painted(along(new CylinderGeometry(radius, radius, to - from, 7, 1, true), (from + to) / 2), color);
  return merged([
    painted(new ConeGeometry(0.0062, 0.036, 8).rotateX(-Math.PI / 2).translate(0, 0, 0.018), '#8d99a6'),
    rod(0.036, 0.056, 0.0056, '#6d7883'),
    rod(0.056, length - 0.19, shaftRadius, '#e2bd86'),
    rod(length - 0.19, length - 0.165, shaftRadius * 1.06, '#1e2a38'),
    rod(length - 0.165, length - 0.03, shaftRadius, '#f2e7cf'),
    rod(length - 0.03, length, shaftRadius * 1.15, '#1e2a38'),
    vane(0, length, '#ff9d1f'),
    vane((2 * Math.PI) / 3, length, '#fbfaf4'),
    vane((-2 * Math.PI) / 3, length, '#fbfaf4'),
  ]);
}

const minusZ = new Vector3(0, 0, -1);

/** Creates the mesh of all visible arrows, one draw call; arena frame. `length` [m]: from tip to nock. */
export function createArrows(length: number) {
  const object = new InstancedMesh(arrowGeometry(length), new MeshLambertMaterial({ vertexColors: true }), capacity);
  object.name = 'arrows';
  object.instanceMatrix.setUsage(DynamicDrawUsage);
  object.frustumCulled = false;
  object.castShadow = true;
  object.count = 0;
  const matrix = new Matrix4();
  const turn = new Quaternion();
  const place = new Vector3();
  const heading = new Vector3();
  const size = new Vector3(1, 1, 1);
  const pose = makeArrowPose();

  function set(index: number, { tip, direction }: ArrowPose): void {
    turn.setFromUnitVectors(minusZ, heading.copy(direction));
    object.setMatrixAt(index, matrix.compose(place.copy(tip), turn, size));
  }

  return {
    object,
    /** Shows the arrows shot by a match time [s], and the one on the string; null: none. */
    show(arrows: readonly Arrow[], time: number, nocked: ArrowPose | null): void {
      let count = 0;
      for (let i = Math.max(0, arrows.length - capacity + 1); i < arrows.length; i++) {
        const arrow = arrows[i]!;
        if (arrow.release.time > time) continue;
        set(count, arrowPose(arrow, time, pose));
        count += 1;
      }
      if (nocked) set(count, nocked);
      object.count = count + (nocked ? 1 : 0);
      object.instanceMatrix.needsUpdate = true;
    },
  };
}
