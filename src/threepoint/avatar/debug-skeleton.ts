import {
  BufferAttribute,
  BufferGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  type Object3D,
  Points,
  PointsMaterial,
} from 'three';
import { parentOf } from '../core/body/joints';
import { sides } from '../core/math/side';
import type { Vec3 } from '../core/math/vec3';

/** Lines from joint to joint, drawn through the skin. */
interface DebugSkeleton {
  readonly object: Object3D;
  setVisible(visible: boolean): void;
  /** Sets the joints in the floor frame [m], as returned by `Avatar.jointPositions`. */
  setJoints(joints: Readonly<Record<string, Vec3 | undefined>>): void;
  dispose(): void;
}

const bonesDrawn: readonly (readonly [string, string])[] = [
  ...Object.entries(parentOf).flatMap(([joint, parent]) => (parent ? [[parent, joint] as const] : [])),
  ...sides.flatMap((side) => [
    ['hips', `${side}UpperLeg`] as const,
    [`${side}UpperLeg`, `${side}LowerLeg`] as const,
    [`${side}LowerLeg`, `${side}Foot`] as const,
  ]),
];
const dots = [...new Set(bonesDrawn.flat())];

/** The height [m] of missing joints, far below the floor. */
const farBelow: Vec3 = { x: 0, y: -1000, z: 0 };

export function createDebugSkeleton(): DebugSkeleton {
  const object = new Group();
  object.name = 'debug skeleton';
  object.visible = false;
  const attribute = (count: number) => new BufferAttribute(new Float32Array(count * 3), 3);
  const geometries = [new BufferGeometry(), new BufferGeometry()] as const;
  geometries[0].setAttribute('position', attribute(bonesDrawn.length * 2));
  geometries[1].setAttribute('position', attribute(dots.length));
  const over = { depthTest: false, transparent: true } as const;
  const lines = new LineSegments(geometries[0], new LineBasicMaterial({ color: 0x39d0ff, ...over }));
  const points = new Points(geometries[1], new PointsMaterial({ color: 0xffd34d, size: 0.022, ...over }));
  for (const part of [lines, points]) {
    part.frustumCulled = false;
    part.renderOrder = 10;
    object.add(part);
  }

  const [linePlaces, dotPlaces] = geometries.map((geometry) => geometry.getAttribute('position')) as [
    BufferAttribute,
    BufferAttribute,
  ];

  return {
    object,
    setVisible(visible) {
      object.visible = visible;
    },
    setJoints(joints) {
      if (!object.visible) return;
      let ends = 0;
      for (const [from, to] of bonesDrawn) {
        const start = joints[from];
        const end = joints[to];
        if (!start || !end) continue;
        linePlaces.setXYZ(ends, start.x, start.y, start.z);
        linePlaces.setXYZ(ends + 1, end.x, end.y, end.z);
        ends += 2;
      }
      linePlaces.needsUpdate = true;
      geometries[0].setDrawRange(0, ends);
      for (let index = 0; index < dots.length; index++) {
        const at = joints[dots[index]!] ?? farBelow;
        dotPlaces.setXYZ(index, at.x, at.y, at.z);
      }
      dotPlaces.needsUpdate = true;
    },
    dispose() {
      for (const geometry of geometries) geometry.dispose();
      lines.material.dispose();
      points.material.dispose();
      object.removeFromParent();
    },
  };
}
