import {
  BoxGeometry,
  type BufferGeometry,
  CircleGeometry,
  Color,
  CylinderGeometry,
  Group,
  InstancedMesh,
  type Material,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  TorusGeometry,
  Vector3,
} from 'three';
import { clamp } from 'threepoint/math';
import type { ArcheryState, Target } from 'threepoint-games/archery';
import { drawText } from 'threepoint-ui/vr';
import { ink } from '../../scene/boards/board-style';
import { createLabelQuad } from '../../scene/boards/label-quad';
import { createCanvasTexture, type DrawableTexture } from '../../scene/canvas-texture';
import { disposeTree } from '../../scene/dispose-tree';
import { createContactShadows } from '../../scene/outdoors/contact-shadows';
import { woodColor } from '../../scene/outdoors/wood-color';
import { merged, painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';
import { createRingTexture } from './target-rings';

const discThickness = 0.1;
const gap = 0.05;

/** Returns the size of a target's plate [m], which grows with the distance so that all are equally legible. */
const plateOf = ({ distance }: Target): { readonly width: number; readonly height: number } => {
  const width = 0.34 * clamp(distance / 6.5, 0.85, 1.5);
  return { width, height: (width * cell.height) / cell.width };
};
const cell = { width: 256, height: 150 };
/** Duration of the pulse of a rim after a hit [s]. */
const pulseSeconds = 0.7;

/** Returns the transform of a target: origin at the centre of its painted side, +Z out of it, +Y up. */
function placeOf({ centre, normal }: Target): Matrix4 {
  const z = new Vector3(normal.x, normal.y, normal.z);
  const x = new Vector3(0, 1, 0).cross(z).normalize();
  const y = z.clone().cross(x);
  return new Matrix4().makeBasis(x, y, z).setPosition(centre.x, centre.y, centre.z);
}

/** A square beam from one point to another, both in the world. */
function beam(from: Vector3, to: Vector3, thickness: number, seed: number): BufferGeometry {
  const along = to.clone().sub(from);
  const length = along.length();
  const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
  const middle = from.clone().lerp(to, 0.5);
  const geometry = new BoxGeometry(thickness, length, thickness)
    .applyQuaternion(turn)
    .translate(middle.x, middle.y, middle.z);
  return painted(geometry, woodColor(seed));
}

/** Straw disc, two legs in front, one behind, a bar that carries the disc, the board of the plate. */
function standGeometry(target: Target, index: number): BufferGeometry[] {
  const place = placeOf(target);
  const { radius } = target;
  const plate = plateOf(target);
  const at = (x: number, y: number, z: number) => new Vector3(x, y, z).applyMatrix4(place);
  const top = plate.height + gap + radius + 0.03;
  const foot = (x: number, z: number) => {
    const point = at(x, 0, z);
    return point.setY(-0.02);
  };
  const behind = -discThickness - 0.03;
  const straw = painted(
    new CylinderGeometry(radius, radius, discThickness, 48, 1, true)
      .rotateX(Math.PI / 2)
      .translate(0, 0, -discThickness / 2),
    '#c9a866',
  ).applyMatrix4(place);
  const binding = painted(
    new CylinderGeometry(radius * 1.004, radius * 1.004, 0.02, 48, 1, true).rotateX(Math.PI / 2).translate(0, 0, -0.06),
    '#8f6f3d',
  ).applyMatrix4(place);
  const back = painted(
    new CircleGeometry(radius, 40).rotateY(Math.PI).translate(0, 0, -discThickness),
    '#b8945a',
  ).applyMatrix4(place);
  const board = painted(
    new BoxGeometry(plate.width + 0.03, plate.height + 0.03, 0.022).translate(
      0,
      radius + gap + plate.height / 2,
      -0.03,
    ),
    '#5b4230',
  ).applyMatrix4(place);
  const spread = radius * 0.95;
  return [
    straw,
    binding,
    back,
    board,
    beam(foot(-spread, -0.13), at(-0.06, top, behind), 0.046, index),
    beam(foot(spread, -0.13), at(0.06, top, behind), 0.046, index + 1),
    beam(foot(0, -0.95), at(0, top - 0.06, behind - 0.04), 0.046, index + 2),
    beam(at(-spread * 0.72, -radius - 0.03, -0.075), at(spread * 0.72, -radius - 0.03, -0.075), 0.06, index + 3),
  ];
}

/** A plate's quad, before its board, with its row of the texture. */
function plateGeometry(target: Target, row: number, rows: number): BufferGeometry {
  const { width, height } = plateOf(target);
  return createLabelQuad(width, height, row, rows)
    .translate(0, target.radius + gap + height / 2, -0.016)
    .applyMatrix4(placeOf(target));
}

interface Score {
  /** 0: nothing yet. */
  points: number;
  /** When the last arrow hit, in the match's time [s]; −∞: none did. */
  at: number;
}

const makeScore = (): Score => ({ points: 0, at: Number.NEGATIVE_INFINITY });

/** Writes the points of a target at a match time [s], and the time of the last hit, into `score`. */
export function scoredBy(state: ArcheryState, target: number, time: number, score: Score = makeScore()): Score {
  score.points = 0;
  score.at = Number.NEGATIVE_INFINITY;
  for (const { landing } of state.arrows) {
    if (!landing || landing.target !== target || landing.points === 0 || landing.time > time) continue;
    score.points += landing.points;
    score.at = Math.max(score.at, landing.time);
  }
  return score;
}

/** A plate: dark with the points it is worth, or light with a tick and the points it gave. */
function paintPlate(context: CanvasRenderingContext2D, row: number, points: number, scored: number): void {
  const y = row * cell.height;
  context.save();
  context.translate(0, y);
  context.fillStyle = scored === 0 ? ink.board : ink.accent;
  context.fillRect(0, 0, cell.width, cell.height);
  context.strokeStyle = scored === 0 ? ink.text : ink.accentInk;
  context.lineWidth = 6;
  context.strokeRect(9, 9, cell.width - 18, cell.height - 18);
  const writing = { font: '800 108px', align: 'center', baseline: 'middle' } as const;
  const middle = cell.height / 2 + 8;
  if (scored === 0) drawText(context, String(points), [cell.width / 2, middle], { ...writing, color: ink.text });
  else {
    drawText(context, String(scored), [cell.width * 0.64, middle], { ...writing, color: ink.accentInk });
    context.strokeStyle = ink.accentInk;
    context.lineWidth = 17;
    context.lineCap = context.lineJoin = 'round';
    context.beginPath();
    context.moveTo(32, 78);
    context.lineTo(54, 102);
    context.lineTo(90, 50);
    context.stroke();
  }
  context.restore();
}

const unlit = new Color('#6b4f35');
const lit = new Color('#ffe9a6');
const untouched = new Color('#ffffff');
const done = new Color('#b0b0b0');

/** The painted sides, in the order of the targets. */
function createFaces(count: number, material: Material): InstancedMesh {
  const faces = new InstancedMesh(new CircleGeometry(1, 56), material, count);
  faces.receiveShadow = true;
  return faces;
}

/** The rings round the faces, in the order of the targets. */
function createRims(count: number, material: Material, quality: Quality): InstancedMesh {
  const [around, along] = quality === 'high' ? [10, 64] : [4, 36];
  return new InstancedMesh(new TorusGeometry(1.012, 0.021, around, along), material, count);
}

const createShadows = (targets: readonly Target[]): Mesh =>
  createContactShadows(
    targets.map(({ centre, normal, radius }) => ({
      x: centre.x - normal.x * 0.25,
      z: centre.z - normal.z * 0.25,
      width: radius * 3,
      depth: 1.5,
    })),
  );

/** Returns the scale of a rim at a time after the hit [s]. */
const swellAt = (since: number): number => {
  const share = since / pulseSeconds;
  return share < 1 ? 1 + 0.09 * Math.sin(share * Math.PI) * (1 - share) : 1;
};

function changed(mesh: InstancedMesh): void {
  mesh.instanceMatrix.needsUpdate = true;
  if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  mesh.computeBoundingSphere();
}

/** Four discs on wooden legs, each with a plate that shows its points; arena frame. */
export class TargetStands {
  readonly object = new Group();
  readonly #quality: Quality;
  readonly #wood = new MeshLambertMaterial({ vertexColors: true });
  readonly #face: MeshLambertMaterial;
  readonly #glow = new MeshBasicMaterial({ color: '#ffffff' });
  readonly #plates: DrawableTexture;
  readonly #plateMaterial: MeshBasicMaterial;
  readonly #size = new Matrix4();
  #built: readonly Target[] = [];
  /** The built targets as JSON. */
  #builtAs = '';
  /** The place of each target, its score, and the points on its plate; no points: nothing is painted yet. */
  #places: readonly Matrix4[] = [];
  #scores: readonly Score[] = [];
  #onPlates: number[] = [];
  /** null: there are no targets; likewise for rims and shadows. */
  #faces: InstancedMesh | null = null;
  #rims: InstancedMesh | null = null;
  #shadows: Mesh | null = null;

  constructor(quality: Quality) {
    this.#quality = quality;
    this.object.name = 'targets';
    this.#face = new MeshLambertMaterial({ map: createRingTexture(quality) });
    this.#plates = createCanvasTexture(cell.width, cell.height * 4, quality);
    this.#plateMaterial = new MeshBasicMaterial({ map: this.#plates.texture });
  }

  /**
   * Stands and plates for a state at a time of the match [s]: what has scored is lit, ticked and marked with its
   * points.
   */
  show(state: ArcheryState, time: number): void {
    const { targets } = state;
    this.#setTargets(targets);
    const faces = this.#faces;
    const rims = this.#rims;
    if (!faces || !rims) return;
    for (let index = 0; index < targets.length; index++) {
      const { radius } = targets[index]!;
      const score = scoredBy(state, index, time, this.#scores[index]);
      const hit = score.points > 0;
      const place = this.#places[index]!;
      faces.setMatrixAt(index, this.#size.makeScale(radius, radius, 1).premultiply(place));
      const wide = hit ? radius * swellAt(time - score.at) * 1.012 : radius;
      rims.setMatrixAt(index, this.#size.makeScale(wide, wide, hit ? radius * 1.5 : radius).premultiply(place));
      faces.setColorAt(index, hit ? done : untouched);
      rims.setColorAt(index, hit ? lit : unlit);
    }
    changed(faces);
    changed(rims);
    this.#showPlates(targets);
  }

  /** Rebuilds the stands if the targets differ. A received or replayed state has new objects for the same targets. */
  #setTargets(targets: readonly Target[]): void {
    if (targets === this.#built) return;
    this.#built = targets;
    const key = JSON.stringify(targets);
    if (key === this.#builtAs) return;
    this.#builtAs = key;
    this.#clear();
    if (targets.length > 0) this.#build(targets);
  }

  /**
   * Removes the stands. Their materials are kept for the next ones, except those of the shadows, which have a texture.
   */
  #clear(): void {
    if (this.#shadows) disposeTree(this.#shadows);
    for (const child of [...this.object.children]) {
      this.object.remove(child);
      if (child instanceof Mesh) child.geometry.dispose();
      if (child instanceof InstancedMesh) child.dispose();
    }
    this.#onPlates = [];
    this.#faces = this.#rims = this.#shadows = null;
  }

  #build(targets: readonly Target[]): void {
    const count = targets.length;
    this.#places = targets.map(placeOf);
    this.#scores = targets.map(makeScore);
    const stands = new Mesh(merged(targets.flatMap(standGeometry)), this.#wood);
    stands.castShadow = stands.receiveShadow = true;
    this.#faces = createFaces(count, this.#face);
    this.#rims = createRims(count, this.#glow, this.#quality);
    this.#shadows = createShadows(targets);
    const plates = merged(targets.map((target, row) => plateGeometry(target, row, count)));
    this.object.add(stands, this.#faces, this.#rims, new Mesh(plates, this.#plateMaterial), this.#shadows);
  }

  #showPlates(targets: readonly Target[]): void {
    let changed = false;
    for (let row = 0; row < targets.length; row++) {
      const { points } = this.#scores[row]!;
      if (points === this.#onPlates[row]) continue;
      this.#onPlates[row] = points;
      changed = true;
    }
    if (!changed) return;
    this.#plates.draw((context) => {
      context.scale(1, 4 / targets.length);
      for (const [row, { points }] of targets.entries()) paintPlate(context, row, points, this.#onPlates[row]!);
      context.resetTransform();
    });
  }
}
