import {
  BoxGeometry,
  BufferGeometry,
  CircleGeometry,
  Color,
  CylinderGeometry,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  TorusGeometry,
  Vector3,
} from 'three';
import type { ArcheryState, Target } from '../../core/games/archery/archery-state';
import { clamp } from '../../core/math/damper';
import { ink, signFont } from '../../scene/boards/lettering';
import { disposeTree } from '../../scene/dispose-tree';
import { createDrawnTexture } from '../../scene/drawn-texture';
import { createContactShadows } from '../../scene/outdoors/contact-shadows';
import { woodColor } from '../../scene/outdoors/wood';
import { merged, painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';
import { createRingTexture } from './target-rings';

/** Four discs on wooden legs, each with a plate that says what it is worth; arena frame. */
export interface TargetStands {
  readonly object: Group;
  /** Stands and plates for a state at a time of the match [s]: what has scored is lit, ticked and marked with its points. */
  show(state: ArcheryState, time: number): void;
  dispose(): void;
}

const discThickness = 0.1;
const gap = 0.05;

/** Size of a target's plate [m]: larger further away, so that all are read as easily. */
const plateOf = ({ distance }: Target): { readonly width: number; readonly height: number } => {
  const width = 0.34 * clamp(distance / 6.5, 0.85, 1.5);
  return { width, height: (width * cell.height) / cell.width };
};
const cell = { width: 256, height: 150 };
/** Seconds in which the rim of a disc that was hit swells and calms. */
const pulseSeconds = 0.7;

/** Takes a geometry that faces +Z to a target: origin at the centre of its painted side, +Z out of it, +Y up. */
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
  const plate = plateOf(target);
  const low = target.radius + gap;
  const corners = [
    [-1, 0],
    [1, 0],
    [1, 1],
    [-1, 0],
    [1, 1],
    [-1, 1],
  ] as const;
  const geometry = new BufferGeometry();
  geometry.setAttribute(
    'position',
    new Float32BufferAttribute(
      corners.flatMap(([x, y]) => [(x * plate.width) / 2, low + y * plate.height, -0.016]),
      3,
    ),
  );
  geometry.setAttribute(
    'uv',
    new Float32BufferAttribute(
      corners.flatMap(([x, y]) => [(x + 1) / 2, 1 - (row + 1 - y) / rows]),
      2,
    ),
  );
  return geometry.applyMatrix4(placeOf(target));
}

/** What a target scored so far, and when last; null: nothing yet. */
export function scoredBy(
  state: ArcheryState,
  target: number,
  time: number,
): { readonly points: number; readonly at: number } | null {
  let points = 0;
  let at = Number.NEGATIVE_INFINITY;
  for (const { landing } of state.arrows) {
    if (!landing || landing.target !== target || landing.points === 0 || landing.time > time) continue;
    points += landing.points;
    at = Math.max(at, landing.time);
  }
  return points > 0 ? { points, at } : null;
}

/** A plate: dark with the points it is worth, or light with a tick and the points it gave. */
function paintPlate(context: CanvasRenderingContext2D, row: number, points: number, scored: number | null): void {
  const y = row * cell.height;
  context.save();
  context.translate(0, y);
  context.fillStyle = scored === null ? ink.board : ink.accent;
  context.fillRect(0, 0, cell.width, cell.height);
  context.strokeStyle = scored === null ? ink.text : ink.accentInk;
  context.lineWidth = 6;
  context.strokeRect(9, 9, cell.width - 18, cell.height - 18);
  context.fillStyle = scored === null ? ink.text : ink.accentInk;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.font = `800 108px ${signFont}`;
  if (scored === null) context.fillText(String(points), cell.width / 2, cell.height / 2 + 8);
  else {
    context.fillText(String(scored), cell.width * 0.64, cell.height / 2 + 8);
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

export function createTargetStands(quality: Quality): TargetStands {
  const object = new Group();
  object.name = 'targets';
  const wood = new MeshLambertMaterial({ vertexColors: true });
  const face = new MeshLambertMaterial({ map: createRingTexture(quality) });
  const glow = new MeshBasicMaterial({ color: '#ffffff' });
  const plates = createDrawnTexture(cell.width, cell.height * 4, quality);
  const plateMaterial = new MeshBasicMaterial({ map: plates.texture });

  let built: readonly Target[] = [];
  let builtAs = '';
  let shownPlates = '';
  let faces: InstancedMesh | null = null;
  let rims: InstancedMesh | null = null;
  let shadows: Mesh | null = null;

  function build(targets: readonly Target[]): void {
    // The other materials stay for the next stands; the shadows have their own, and a texture.
    if (shadows) disposeTree(shadows);
    for (const child of [...object.children]) {
      object.remove(child);
      if (child instanceof Mesh) child.geometry.dispose();
      if (child instanceof InstancedMesh) child.dispose();
    }
    shownPlates = '';
    faces = rims = shadows = null;
    if (targets.length === 0) return;
    const stands = new Mesh(merged(targets.flatMap(standGeometry)), wood);
    stands.castShadow = stands.receiveShadow = true;
    faces = new InstancedMesh(new CircleGeometry(1, 56), face, targets.length);
    faces.receiveShadow = true;
    rims = new InstancedMesh(
      new TorusGeometry(1.012, 0.021, quality === 'high' ? 10 : 4, quality === 'high' ? 64 : 36),
      glow,
      targets.length,
    );
    shadows = createContactShadows(
      targets.map(({ centre, normal, radius }) => ({
        x: centre.x - normal.x * 0.25,
        z: centre.z - normal.z * 0.25,
        width: radius * 3,
        depth: 1.5,
      })),
    );
    const signs = new Mesh(
      merged(targets.map((target, row) => plateGeometry(target, row, targets.length))),
      plateMaterial,
    );
    object.add(stands, faces, rims, signs, shadows);
  }

  const place = new Matrix4();
  const size = new Matrix4();

  return {
    object,
    show(state, time) {
      if (state.targets !== built) {
        // A state that travelled or was replayed has other objects for the same targets.
        built = state.targets;
        const key = JSON.stringify(built);
        if (key !== builtAs) build(built);
        builtAs = key;
      }
      if (!faces || !rims) return;
      const scores = state.targets.map((_, index) => scoredBy(state, index, time));
      for (const [index, target] of state.targets.entries()) {
        const score = scores[index] ?? null;
        place.copy(placeOf(target));
        faces.setMatrixAt(index, size.makeScale(target.radius, target.radius, 1).premultiply(place));
        faces.setColorAt(index, score ? done : untouched);
        const since = score ? (time - score.at) / pulseSeconds : 1;
        const swell = since < 1 ? 1 + 0.09 * Math.sin(since * Math.PI) * (1 - since) : 1;
        const thick = target.radius * swell * (score ? 1.012 : 1);
        rims.setMatrixAt(
          index,
          size.makeScale(thick, thick, score ? target.radius * 1.5 : target.radius).premultiply(place),
        );
        rims.setColorAt(index, score ? lit : unlit);
      }
      for (const mesh of [faces, rims]) {
        mesh.instanceMatrix.needsUpdate = true;
        if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
        mesh.computeBoundingSphere();
      }
      const wanted = JSON.stringify(scores.map((score) => score?.points ?? null));
      if (wanted === shownPlates) return;
      shownPlates = wanted;
      plates.draw((context) => {
        context.scale(1, 4 / state.targets.length);
        for (const [row, { points }] of state.targets.entries())
          paintPlate(context, row, points, scores[row]?.points ?? null);
        context.resetTransform();
      });
    },
    dispose() {
      object.removeFromParent();
      disposeTree(object);
      plates.texture.dispose();
    },
  };
}
