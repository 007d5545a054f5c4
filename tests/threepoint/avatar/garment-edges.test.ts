import { Matrix4, Ray, SkinnedMesh, Vector3 } from 'three';
import { describe, expect, test } from 'vitest';
import type { Avatar } from '../../../src/threepoint/avatar/avatar';
import { defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { figures } from '../../../tools/avatars/build/bodies';
import type { Figure, Label } from '../../../tools/avatars/build/figure';
import { trimWidth } from '../../../tools/avatars/build/garments';
import { postures } from '../../../tools/avatars/try/postures';
import { builtInBody } from './drawn-skin';
import { placeOf } from './skin-cuts';

const people = figures.filter(({ pieces }) => pieces);
/** Arms are spread. */
const arms = postures.find(({ name }) => name === 'T-pose')!;

/** An edge of a garment: rays come from all sides towards a line inside, and move with a bone. */
interface Edge {
  readonly bone: string;
  /** Returns a place of the line, so far past the edge [m]. */
  readonly at: (past: number) => Vector3;
  /** Two directions across the line. */
  readonly across: readonly [Vector3, Vector3];
  /** How far from the line rays begin [m]: nearer than the other leg, or a raised arm. */
  readonly from: number;
}

/** How far a place is past the nearest edge of a garment with such a trim [m]. */
const pastEdge =
  ({ seams }: Figure, trim: Label) =>
  (...at: [number, number, number]): number =>
    -seams.find(({ label }) => label === trim)!.line!(...at) - trimWidth;

function edgesOf(figure: Figure): Readonly<Record<string, Edge>> {
  const { armHeight, armDepth, armJoints } = figure.rig;
  const [top, bottom] = [pastEdge(figure, 'TopTrim'), pastEdge(figure, 'BottomTrim')];
  const sleeve = 1 - top(1, armHeight, armDepth);
  const [hem, cuff] = [0.5 + top(0, 0.5, 0), bottom(0.1, 0, 0)];
  const [x, y, z] = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
  return {
    collar: { bone: 'upperChest', at: (past) => new Vector3(0, 1.43 + past, -0.01), across: [x, z], from: 0.13 },
    hem: { bone: 'hips', at: (past) => new Vector3(0, hem - past, 0), across: [x, z], from: 0.24 },
    sleeve: {
      bone: sleeve > armJoints.elbow ? 'leftLowerArm' : 'leftUpperArm',
      at: (past) => new Vector3(sleeve + past, armHeight, armDepth),
      across: [y, z],
      from: 0.09,
    },
    cuff: { bone: 'leftLowerLeg', at: (past) => new Vector3(0.1, cuff - past, -0.015), across: [x, z], from: 0.085 },
  };
}

interface Triangle {
  readonly mesh: SkinnedMesh;
  readonly corners: readonly [number, number, number];
}

const cornersOf = ({ geometry }: SkinnedMesh): Triangle['corners'][] =>
  Array.from({ length: geometry.index!.count / 3 }, (_, t) => {
    const corner = (i: number) => geometry.index!.getX(3 * t + i);
    return [corner(0), corner(1), corner(2)] as const;
  });

/** The triangles that lie at rest beside an edge. */
function trianglesAt({ object }: Avatar, { at, across, from }: Edge): Triangle[] {
  const found: Triangle[] = [];
  const along = across[0].clone().cross(across[1]);
  object.traverse((mesh) => {
    if (!(mesh instanceof SkinnedMesh)) return;
    const places = mesh.geometry.attributes.position!;
    for (const corners of cornersOf(mesh)) {
      const off = new Vector3().fromBufferAttribute(places, corners[0]).sub(at(0));
      const far = off.dot(along);
      if (Math.abs(far) < 0.08 && off.addScaledVector(along, -far).length() < from) found.push({ mesh, corners });
    }
  });
  return found;
}

/** Whether it is the inside of clothes: dark by the colour of its vertices, and bluish grey like nothing else. */
function isLining({ mesh, corners }: Triangle): boolean {
  const color = mesh.geometry.attributes.color;
  const [r, g, b] = [0, 1, 2].map((channel) => color?.getComponent(corners[0], channel) ?? 1) as [
    number,
    number,
    number,
  ];
  return r < 0.26 && Math.abs(r - g) < 1e-3 && b > r;
}

const sides = 40;
/** The number of rays of a thousand that may graze a fold too small to be seen. */
const grazing = 1;
/** Steps along an edge, before and past it [m]. */
const heights = Array.from({ length: 31 }, (_, i) => 0.002 * (i - 15));

/** How often rays from all sides hit something at an edge, the back of a triangle, and the inside of clothes. */
function seen(avatar: Avatar, { body }: Figure, edge: Edge) {
  const triangles = trianglesAt(avatar, edge);
  const bone = avatar.object.getObjectByName(edge.bone)!;
  const { skeleton } = triangles[0]!.mesh;
  const moved = new Matrix4().multiplyMatrices(
    bone.matrixWorld,
    skeleton.boneInverses[skeleton.bones.findIndex(({ name }) => name === edge.bone)]!,
  );
  const drawn = triangles.map((triangle) => ({
    triangle,
    places: triangle.corners.map((corner) => placeOf(triangle.mesh, corner)) as [Vector3, Vector3, Vector3],
  }));
  const counts = { hits: 0, backs: 0, linings: 0 };
  const ray = new Ray();
  const hit = new Vector3();
  for (const past of heights) {
    for (let side = 0; side < sides; side++) {
      const turn = (2 * Math.PI * side) / sides;
      const away = edge.across[0]
        .clone()
        .multiplyScalar(Math.cos(turn))
        .addScaledVector(edge.across[1], Math.sin(turn));
      const target = edge.at(past).applyMatrix4(moved);
      ray.origin.copy(edge.at(past).addScaledVector(away, edge.from));
      // Shoulders are there.
      if (body(...ray.origin.toArray()) < 0.02) continue;
      ray.origin.applyMatrix4(moved);
      ray.direction.copy(target).sub(ray.origin).normalize();
      let nearest = edge.from;
      let found: (typeof drawn)[number] | null = null;
      for (const one of drawn) {
        if (!ray.intersectTriangle(...one.places, false, hit)) continue;
        const far = hit.distanceTo(ray.origin);
        if (far < nearest) [nearest, found] = [far, one];
      }
      if (!found) continue;
      counts.hits += 1;
      const [a, b, c] = found.places;
      if (b.clone().sub(a).cross(c.clone().sub(a)).dot(ray.direction) > 0) counts.backs += 1;
      if (isLining(found.triangle)) counts.linings += 1;
    }
  }
  return counts;
}

describe.each(people.map((figure) => [figure.name, figure] as const))('the clothes of the %s', (name, figure) => {
  test('show from every side neither a gap nor their inside at collar, hem, sleeve and cuff', {
    tags: ['full'],
  }, async () => {
    const avatar = await builtInBody(name);
    const estimator = createIk(defaultCalibration);
    avatar.setCalibration(defaultCalibration);
    avatar.setPose(estimator.update(arms.frame).pose, 0);
    avatar.object.updateMatrixWorld(true);
    for (const [which, edge] of Object.entries(edgesOf(figure))) {
      const { hits, backs, linings } = seen(avatar, figure, edge);
      expect(hits, which).toBeGreaterThan(300);
      expect(backs, `backs of triangles at the ${which}`).toBeLessThanOrEqual(grazing);
      expect(linings, `the inside of clothes at the ${which}`).toBeLessThanOrEqual(grazing);
    }
    avatar.dispose();
  });
});
