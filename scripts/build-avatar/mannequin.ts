import { body } from './anatomy';
import { armJoints, hipLine } from './rig';
import { compact, cutAlong, decimate, mesh, normalsOf, projectOnto, type Surface } from './surface';
import { skinWeights } from './weights';
import { type MaterialName, writeVrm } from './write-vrm';

/** Finer than a finger's fillet. */
const cell = 0.0042;
const triangleBudget = 11_500;

const smoothstep = (start: number, end: number, value: number): number => {
  const t = Math.max(0, Math.min(1, (value - start) / (end - start)));
  return t * t * (3 - 2 * t);
};

/** Where people look: face, hands, shoulders. */
function importance({ positions }: Surface): Float32Array {
  return Float32Array.from({ length: positions.length / 3 }, (_, v) => {
    const x = Math.abs(positions[3 * v]!);
    const y = positions[3 * v + 1]!;
    const z = positions[3 * v + 2]!;
    const face = smoothstep(1.47, 1.53, y) * smoothstep(-0.01, 0.05, z);
    const hand = smoothstep(armJoints.wrist - 0.02, armJoints.wrist + 0.03, x);
    return Math.max(face, hand, 0.25 * smoothstep(1.3, 1.36, y));
  });
}

/** Seams: where each function is zero the material changes; negative is the named material. */
const seams: readonly {
  readonly material: MaterialName;
  readonly value: (x: number, y: number, z: number) => number;
}[] = [
  // The face behind a visor that wraps from temple to temple.
  {
    material: 'Visor',
    value: (x, y, z) => Math.max(Math.abs(y - 1.592 + 0.1 * Math.abs(x)) - 0.026, 0.032 - z + 0.0 * x) + 0.06 * x * x,
  },
  // Gloves with a slanted cuff, boots, and a collar that runs into a yoke over the shoulders.
  { material: 'Accent', value: (x) => armJoints.wrist - 0.045 - Math.abs(x) },
  { material: 'Accent', value: (_, y, z) => y - 0.13 - 0.12 * z },
  { material: 'Accent', value: (x, y, z) => yoke(x, y, z) },
  { material: 'Head', value: (_, y, z) => collar(z) - y },
  // No change of colour: a clean edge for those who show the upper body alone.
  { material: 'Suit', value: (_, y) => y - hipLine },
];

/** Height [m] of the collar, where the head's mesh begins: under the chin, a little higher at the nape. */
const collar = (z: number): number => 1.452 - 0.12 * z;

/** A yoke: from the collar over the shoulders, pointed at the breastbone; stops before the deltoid. */
function yoke(x: number, y: number, z: number): number {
  const side = Math.abs(x);
  const hem = z > 0 ? 1.345 + 0.28 * side : 1.33 + 0.25 * side;
  return Math.max(hem - y, y - collar(z), side - 0.15);
}

/** The first seam that has a triangle's middle on its inner side decides; all else is the suit. */
function materialAt(x: number, y: number, z: number): MaterialName {
  return seams.find(({ value }) => value(x, y, z) < 0)?.material ?? 'Suit';
}

/** The mannequin as a VRM 1.0 file; the same bytes every time. */
export async function buildMannequin(report?: (what: string) => void): Promise<Uint8Array> {
  const fine = projectOnto(body, mesh(body, [-0.92, -0.02, -0.2], [0.92, 1.74, 0.24], cell), 2);
  report?.(`${fine.indices.length / 3} triangles of ${cell * 1000} mm`);
  const coarse = await decimate(fine, normalsOf(body, fine.positions), importance(fine), triangleBudget);
  let surface = projectOnto(body, coarse);
  for (const { value } of seams) surface = cutAlong(surface, value);
  surface = compact(surface);
  report?.(`${surface.indices.length / 3} triangles`);
  const normals = normalsOf(body, surface.positions);
  const skin = skinWeights(surface);
  const materials: MaterialName[] = [];
  for (let t = 0; t < surface.indices.length; t += 3) {
    const middle = [0, 1, 2].map(
      (axis) =>
        [0, 1, 2].reduce((sum, corner) => sum + surface.positions[3 * surface.indices[t + corner]! + axis]!, 0) / 3,
    );
    materials.push(materialAt(middle[0]!, middle[1]!, middle[2]!));
  }
  return writeVrm(surface, normals, skin, materials);
}
