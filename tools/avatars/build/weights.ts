import { type Anatomy, foldedX } from './anatomy';
import type { BodyRig } from './rig';
import { type Surface, smoothOver } from './surface';

/** Four bones and weights per vertex; weights sum to 1. */
export interface SkinWeights {
  readonly joints: Uint8Array;
  readonly weights: Float32Array;
}

const influences = 4;

const smoothstep = (start: number, end: number, value: number): number => {
  const t = Math.max(0, Math.min(1, (value - start) / (end - start)));
  return t * t * (3 - 2 * t);
};

/** The trunk's skin: handed up the spine by height [m], each vertebra blending into the next. */
function trunkWeights(y: number): [string, number][] {
  const toSpine = smoothstep(1.02, 1.16, y);
  const toChest = smoothstep(1.15, 1.27, y);
  const toUpper = smoothstep(1.24, 1.35, y);
  const toNeck = smoothstep(1.405, 1.5, y);
  return [
    ['hips', 1 - toSpine],
    ['spine', toSpine * (1 - toChest)],
    ['chest', toChest * (1 - toUpper)],
    ['upperChest', toUpper * (1 - toNeck)],
    ['neck', toNeck],
  ];
}

/** The collarbone carries the top of the shoulder: its share of the trunk's skin at a point of the left half. */
function shoulderShare(x: number, y: number): number {
  return smoothstep(0.05, 0.15, x) * smoothstep(1.28, 1.38, y);
}

/**
 * Weights by nearness to the parts of the anatomy, then spread over the surface: neighbours across a gap (fingers, arm
 * and flank) share nothing.
 */
export function skinWeights(surface: Surface, { parts, rig }: Pick<Anatomy, 'parts' | 'rig'>): SkinWeights {
  const { bones } = rig;
  const boneIndex = new Map(bones.map((bone, index) => [bone.name, index]));
  const vertices = surface.positions.length / 3;
  const dense = new Float32Array(vertices * bones.length);
  for (let v = 0; v < vertices; v++) {
    const [worldX, y, z] = [surface.positions[3 * v]!, surface.positions[3 * v + 1]!, surface.positions[3 * v + 2]!];
    const x = foldedX(worldX);
    const side = worldX < 0 ? 'right' : 'left';
    const found = new Map<string, number>();
    const give = (bone: string, weight: number) => {
      const name = bone.replace('left', side);
      found.set(name, Math.max(found.get(name) ?? 0, weight));
    };
    const distances = parts.map(({ solid }) => solid.distance(x, y, z));
    const nearest = Math.min(...distances);
    for (const [index, { bone, softness }] of parts.entries()) {
      const weight = Math.exp(-((Math.max(distances[index]! - nearest, 0) / softness) ** 2));
      if (weight < 1e-3) continue;
      if (bone !== 'trunk') {
        give(bone, weight);
        continue;
      }
      const share = shoulderShare(x, y);
      for (const [name, part] of trunkWeights(y)) give(name, weight * part * (name === 'upperChest' ? 1 - share : 1));
      give('leftShoulder', weight * share * smoothstep(1.24, 1.36, y));
    }
    const sum = [...found.values()].reduce((total, weight) => total + weight, 0);
    for (const [name, weight] of found) dense[v * bones.length + boneIndex.get(name)!] = weight / sum;
  }
  sharpenHinges(surface, dense, rig);
  smoothOver(surface, dense, bones.length, 6, 0.5);
  return strongest(dense, vertices, bones.length);
}

/** At elbow and wrist the hand-over is by the distance along the arm, evenly round the limb. */
function sharpenHinges(surface: Surface, dense: Float32Array, { bones, armJoints }: BodyRig): void {
  const boneIndex = new Map(bones.map((bone, index) => [bone.name, index]));
  const hinges = [
    { at: armJoints.elbow, before: 'UpperArm', after: 'LowerArm', width: 0.045 },
    { at: armJoints.wrist - 0.002, before: 'LowerArm', after: 'Hand', width: 0.03 },
  ];
  for (let v = 0; v < surface.positions.length / 3; v++) {
    const x = surface.positions[3 * v]!;
    if (Math.abs(x) < armJoints.shoulder + 0.11) continue;
    const side = x < 0 ? 'right' : 'left';
    for (const { at, before, after, width } of hinges) {
      const a = v * bones.length + boneIndex.get(`${side}${before}`)!;
      const b = v * bones.length + boneIndex.get(`${side}${after}`)!;
      const both = dense[a]! + dense[b]!;
      if (both < 0.5) continue;
      const share = smoothstep(at - width, at + width, Math.abs(x));
      dense[a] = both * (1 - share);
      dense[b] = both * share;
    }
  }
}

/** The four strongest influences of each vertex, made to sum to 1. */
function strongest(dense: Float32Array, vertices: number, bones: number): SkinWeights {
  const joints = new Uint8Array(vertices * influences);
  const weights = new Float32Array(vertices * influences);
  for (let v = 0; v < vertices; v++) {
    const row = Array.from(dense.subarray(v * bones, (v + 1) * bones), (weight, bone) => ({
      bone,
      weight,
    }));
    const best = row.sort((a, b) => b.weight - a.weight || a.bone - b.bone).slice(0, influences);
    const sum = best.reduce((total, { weight }) => total + weight, 0);
    best.forEach(({ bone, weight }, slot) => {
      joints[v * influences + slot] = weight > 0 ? bone : 0;
      weights[v * influences + slot] = weight / sum;
    });
  }
  return { joints, weights };
}
