import { type Anatomy, foldedX } from './anatomy';
import { type BodyRig, hipLine } from './rig';
import { smoothstep } from './signed-distance';
import type { Surface } from './surface';

/** Four bones and weights per vertex; weights sum to 1. */
export interface SkinWeights {
  readonly joints: Uint8Array;
  readonly weights: Float32Array;
}

const influences = 4;

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
export function skinWeights(surface: Surface, anatomy: Anatomy): SkinWeights {
  const { parts, rig } = anatomy;
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
  shareAtHinges(surface, dense, anatomy);
  smoothOver(surface, dense, bones.length, 6, 0.5);
  return strongest(dense, vertices, bones.length);
}

/** A joint at which skin is shared among the bones that meet there by the place alone. */
interface Hinge {
  /** Bones of a body's left half. */
  readonly bones: readonly string[];
  /** Returns the part of each of `bones` at a place of the left half; they sum to 1. null: not at this joint. */
  partsAt(x: number, y: number, z: number): readonly number[] | null;
}

/** At elbow and wrist the hand-over is by the distance along the arm, evenly round the limb. */
const armHinges = ({ shoulder, elbow, wrist }: BodyRig['armJoints']): readonly Hinge[] =>
  [
    { at: elbow, bones: ['leftUpperArm', 'leftLowerArm'], width: 0.045 },
    { at: wrist - 0.002, bones: ['leftLowerArm', 'leftHand'], width: 0.03 },
  ].map(({ at, bones, width }) => ({
    bones,
    partsAt(x) {
      if (x < shoulder + 0.11) return null;
      const share = smoothstep(at - width, at + width, x);
      return [1 - share, share];
    },
  }));

/** The neck takes skin from a ring about its root on, which is higher behind, and so leaves collars to the chest. */
const neckHinge: Hinge = {
  bones: ['upperChest', 'neck'],
  partsAt(x, y, z) {
    if (x > 0.12 || y < 1.36) return null;
    const share = smoothstep(1.44, 1.505, y + 0.12 * z);
    return [1 - share, share];
  },
};

/** How skin passes from the bone above a joint of the leg to the one below. */
interface LegJointSkin {
  /** The middle, above the joint, and half the height of the range, ahead of the joint and behind it [m]. */
  readonly ahead: { readonly above: number; readonly half: number };
  readonly behind: { readonly above: number; readonly half: number };
  /** The distance before and behind the joint at which these hold in full [m]. */
  readonly depth: number;
  /** By how much the middle rises with each metre outwards from the joint. */
  readonly slope: number;
}

/** The groin folds along a line that rises outwards, while the seat stretches; the knee stretches ahead. */
const hipSkin: LegJointSkin = {
  ahead: { above: 0, half: 0.09 },
  behind: { above: -0.01, half: 0.13 },
  depth: 0.08,
  slope: 0.35,
};
const kneeSkin: LegJointSkin = {
  ahead: { above: 0.005, half: 0.075 },
  behind: { above: 0, half: 0.05 },
  depth: 0.045,
  slope: 0,
};

/** The distance from the middle [m] within which both legs share the skin between them, and its height [m]. */
const between = { aside: 0.05, height: 0.08 };

function legHinges({ rig, body }: Anatomy): readonly Hinge[] {
  const shareBelow = (joint: string, { ahead, behind, depth, slope }: LegJointSkin) => {
    const [jointX, jointY, jointZ] = rig.bones.find(({ name }) => name === joint)!.joint;
    return (x: number, y: number, z: number): number => {
      const front = smoothstep(-depth, depth, z - jointZ);
      const half = behind.half + (ahead.half - behind.half) * front;
      const middle = jointY + behind.above + (ahead.above - behind.above) * front + slope * (x - jointX);
      return 1 - smoothstep(middle - half, middle + half, y);
    };
  };
  const [hip, knee] = [shareBelow('leftUpperLeg', hipSkin), shareBelow('leftLowerLeg', kneeSkin)];
  const crotch = crotchOf(body);
  return [
    {
      bones: ['hips', 'leftUpperLeg', 'rightUpperLeg'],
      partsAt(x, y, z) {
        const legs = hip(x, y, z);
        const joined = smoothstep(crotch - between.height / 2, crotch + between.height / 2, y);
        const other = (legs * joined * (1 - smoothstep(0, between.aside, x))) / 2;
        return [1 - legs, legs - other, other];
      },
    },
    {
      bones: ['leftUpperLeg', 'leftLowerLeg'],
      partsAt(x, y, z) {
        const share = knee(x, y, z);
        return [1 - share, share];
      },
    },
  ];
}

/** Returns the height below which the legs are apart [m]. */
function crotchOf(body: Anatomy['body']): number {
  const step = 0.005;
  const isJoined = (y: number) => Array.from({ length: 60 }, (_, i) => body(0, y, step * (i - 30))).some((d) => d < 0);
  let y = hipLine;
  while (y > 0 && isJoined(y)) y -= step;
  return y;
}

const otherSide = (bone: string): string =>
  bone.replace(/^(left|right)/, (side) => (side === 'left' ? 'right' : 'left'));

/** Shares the skin at hinges by the place, however near the parts of the anatomy are. */
function shareAtHinges({ positions }: Surface, dense: Float32Array, anatomy: Anatomy): void {
  const { bones, armJoints } = anatomy.rig;
  const boneIndex = new Map(bones.map((bone, index) => [bone.name, index]));
  const hinges = [...armHinges(armJoints), ...legHinges(anatomy), neckHinge].map((hinge) => ({
    ...hinge,
    left: hinge.bones.map((name) => boneIndex.get(name)!),
    right: hinge.bones.map((name) => boneIndex.get(otherSide(name))!),
  }));
  for (let v = 0; v < positions.length / 3; v++) {
    const [x, y, z] = [positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!];
    const row = dense.subarray(v * bones.length, (v + 1) * bones.length);
    for (const { left, right, partsAt } of hinges) {
      const own = x < 0 ? right : left;
      const sum = own.reduce((total, bone) => total + row[bone]!, 0);
      const parts = sum < 0.5 ? null : partsAt(Math.abs(x), y, z);
      parts?.forEach((part, i) => {
        row[own[i]!] = sum * part;
      });
    }
  }
}

/** Edges shorter than this count like it [m]. */
const shortestEdge = 0.002;

/**
 * The mean of a value per vertex over its neighbours, `rounds` times; channels are interleaved. Near neighbours count
 * for more, so that long edges beside short ones pull nothing along.
 */
function smoothOver(
  { positions, indices }: Surface,
  values: Float32Array,
  channels: number,
  rounds: number,
  rate: number,
): void {
  const vertices = positions.length / 3;
  const neighbours: Map<number, number>[] = Array.from({ length: vertices }, () => new Map());
  for (let t = 0; t < indices.length; t += 3) {
    for (let e = 0; e < 3; e++) {
      const [a, b] = [indices[t + e]!, indices[t + ((e + 1) % 3)]!];
      const apart = Math.hypot(...[0, 1, 2].map((axis) => positions[3 * a + axis]! - positions[3 * b + axis]!));
      const share = 1 / (apart + shortestEdge) ** 2;
      neighbours[a]!.set(b, share);
      neighbours[b]!.set(a, share);
    }
  }
  let from = values.slice();
  const to = values;
  for (let round = 0; round < rounds; round++) {
    for (let v = 0; v < vertices; v++) {
      const around = neighbours[v]!;
      const whole = [...around.values()].reduce((sum, share) => sum + share, 0);
      for (let c = 0; c < channels; c++) {
        let sum = 0;
        for (const [n, share] of around) sum += share * from[n * channels + c]!;
        const own = from[v * channels + c]!;
        to[v * channels + c] = own + (whole > 0 ? sum / whole - own : 0) * rate;
      }
    }
    from = to.slice();
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

/** Returns the weights of vertices that are copies of weighed ones. */
export function copiedWeights({ joints, weights }: SkinWeights, origins: readonly number[]): SkinWeights {
  const pick = (from: Uint8Array | Float32Array) =>
    origins.flatMap((v) => Array.from(from.subarray(influences * v, influences * (v + 1))));
  return { joints: Uint8Array.from(pick(joints)), weights: Float32Array.from(pick(weights)) };
}
