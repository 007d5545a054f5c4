import {
  type BufferGeometry,
  Group,
  InstancedMesh,
  type Material,
  Matrix4,
  MeshLambertMaterial,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three';
import type { GazeTargets } from 'threepoint/internal/three';
import {
  addScaled,
  copyVec3,
  dot,
  length,
  lerp,
  type MutableVec3,
  reject,
  subtract,
  type Transform,
  transformPoint,
  type Vec3,
  vec3,
} from 'threepoint/math';
import {
  type BallLocation,
  type BallState,
  ballPosition,
  ballRadius,
  ballsPerRack,
  basketDepth,
  basketRadius,
  type Opening,
  type TimedLaunch,
} from 'threepoint-games/ball';
import { painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';
import { createShadowDiscs, type ShadowDiscs } from './shadow-discs';

/** Returns the position of a ball in a hand, or null if the hand is not tracked. */
export type InHand = (player: number, side: 'left' | 'right') => Vec3 | null;

/** The looks of the balls of the first rack and of the second. They differ in brightness and in the number of bands. */
const looks = [
  { skin: '#ffd24a', band: '#173a6b', bands: [0] },
  { skin: '#f4f6f8', band: '#7c2413', bands: [-0.36, 0.36] },
] as const;

function geometryOf(look: (typeof looks)[number], quality: Quality) {
  const [around, down] = quality === 'high' ? [40, 28] : [20, 16];
  return painted(new SphereGeometry(ballRadius, around, down), (_x, y, _z, paint) => {
    const onBand = look.bands.some((at) => Math.abs(y / ballRadius - at) < 0.17);
    paint.set(onBand ? look.band : look.skin);
  });
}

/**
 * In the basket balls lie in layers of five about the first one [m, in the basket's frame: outward on two axes, up].
 */
function placeInBasket(index: number): readonly [number, number, number] {
  const layer = Math.floor(index / 5);
  const slot = index % 5;
  const angle = (slot / 5) * 2 * Math.PI + layer * 0.6;
  const out = 0.122;
  return [Math.cos(angle) * out, -basketDepth + ballRadius + 0.01 + layer * 0.085, Math.sin(angle) * out];
}

/** The drawn approach of a flying ball to the basket. */
interface Approach {
  /** The start of its flight [s of the match]. */
  launchedAt: number;
  /**
   * The last drawn position relative to the middle of the opening, with its height above it [m]; NaN: not drawn in this
   * flight yet.
   */
  readonly from: MutableVec3;
  height: number;
  /** It has gone down through the opening. */
  isIn: boolean;
}

const makeApproach = (): Approach => ({ launchedAt: Number.NaN, from: vec3(0, 0, 0), height: Number.NaN, isIn: false });

/** Stops a ball that has passed the opening at the basket's bottom. */
function stopInBasket({ position: middle, normal }: Opening, position: Vec3, launchedAt: number, way: Approach): Vec3 {
  if (way.launchedAt !== launchedAt) way.height = Number.NaN;
  way.launchedAt = launchedAt;
  const from = subtract(position, middle);
  const height = dot(from, normal);
  if (height > 0 || Number.isNaN(way.height)) way.isIn = false;
  else if (way.height > 0) {
    const through = lerp(way.from, from, way.height / (way.height - height));
    way.isIn = length(reject(through, normal)) <= basketRadius;
  }
  way.height = height;
  copyVec3(from, way.from);
  const deepest = ballRadius - basketDepth;
  if (!way.isIn || height > deepest || length(reject(from, normal)) > basketRadius) return position;
  return addScaled(position, normal, deepest - height);
}

const createMaterial = (quality: Quality) =>
  quality === 'high'
    ? new MeshStandardMaterial({ vertexColors: true, roughness: 0.55 })
    : new MeshLambertMaterial({ vertexColors: true });

/** Creates the mesh of a rack's balls, all hidden at first. */
function createMesh(geometry: BufferGeometry, material: Material, count: number): InstancedMesh {
  const mesh = new InstancedMesh(geometry, material, count);
  for (let i = 0; i < count; i++) mesh.setMatrixAt(i, gone);
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.frustumCulled = false;
  return mesh;
}

/** Returns the rotation of a released ball [rad]: a flying one tumbles, a rolling one turns with its distance. */
function turnedBy(
  on: 'air' | 'floor',
  { velocity, position: from, time: since }: TimedLaunch,
  time: number,
  to: Vec3,
): number {
  if (on === 'floor') return Math.hypot(to.x - from.x, to.z - from.z) / ballRadius;
  return Math.min(9, 1.6 * length(velocity)) * Math.max(0, time - since);
}

/** A full basket shows three layers of balls: those below them are hidden. */
const maxInBasket = 15;
const nowhere: Vec3 = vec3(Number.NaN, Number.NaN, Number.NaN);
const gone = new Matrix4().makeScale(0, 0, 0);
const one = new Vector3(1, 1, 1);
const upward = new Vector3(0, 1, 0);

/** All balls of a match, wherever they are; arena frame. */
export class Balls {
  readonly object = new Group();
  /** The balls per rack of the match that is shown. */
  #perRack = 0;
  /** The balls of the first rack and those of the second. */
  readonly #meshes: readonly [InstancedMesh, InstancedMesh];
  readonly #shadows: ShadowDiscs;
  /** By ball. */
  readonly #approaches: readonly Approach[];
  /** The places of balls that fly or are held, by ball; NaN: another ball. */
  readonly #attracting: readonly MutableVec3[];
  readonly #matrix = new Matrix4();
  readonly #at = new Vector3();
  readonly #turn = new Quaternion();
  readonly #axis = new Vector3();
  readonly #inFloor = vec3(0, 0, 0);
  readonly #rolled = new Quaternion();
  readonly #basketTurn = new Quaternion();

  /** `most`: a match may have fewer. */
  constructor(most: number, quality: Quality) {
    const perRack = ballsPerRack(most);
    const material = createMaterial(quality);
    const [first, second] = looks;
    this.#meshes = [
      createMesh(geometryOf(first, quality), material, perRack),
      createMesh(geometryOf(second, quality), material, perRack),
    ];
    this.#shadows = createShadowDiscs(most);
    this.#approaches = Array.from({ length: most }, makeApproach);
    this.#attracting = Array.from({ length: most }, () => copyVec3(nowhere));
    this.object.name = 'balls';
    this.object.add(...this.#meshes, this.#shadows.object);
  }

  /** Shows the balls at a time of the match [s]. `opening`: that of the basket, null while it is not shown. */
  show(state: BallState, time: number, inHand: InHand, opening: Opening | null): void {
    this.#perRack = ballsPerRack(state.options.balls);
    let caught = 0;
    for (let ball = 0; ball < state.balls.length; ball++) {
      const location = state.balls[ball]!;
      let position: Vec3 | null;
      if (location.on === 'hand') position = inHand(location.player, location.side);
      else if (location.on === 'basket') {
        position = opening && caught < maxInBasket ? this.#inBasket(caught, opening) : null;
        caught += 1;
      } else position = ballPosition(state, ball, time);
      // The event of the catch arrives later: until then the ball stays in the basket.
      if (location.on === 'air' && !location.missed && position && opening)
        position = stopInBasket(opening, position, location.launch.time, this.#approaches[ball]!);
      const attracts = location.on === 'air' || location.on === 'hand';
      copyVec3((attracts && position) || nowhere, this.#attracting[ball]!);
      if (position) this.#put(ball, location, position, time);
      else this.#hide(ball);
    }
    for (const mesh of this.#meshes) mesh.instanceMatrix.needsUpdate = true;
    this.#shadows.update();
  }

  /** Adds the balls that fly or are held. */
  addGazeTargets(targets: GazeTargets, floorFromArena: Transform<'floor', 'arena'>): void {
    for (let ball = 0; ball < this.#attracting.length; ball++) {
      targets.add(this.#approaches[ball], transformPoint(floorFromArena, this.#attracting[ball]!, this.#inFloor));
    }
  }

  /** Returns the position in the basket of the ball that was caught after `index` others. */
  #inBasket(index: number, { position, normal }: Opening): Vec3 {
    const [x, y, z] = placeInBasket(index);
    const at = this.#at;
    this.#basketTurn.setFromUnitVectors(upward, at.copy(normal));
    at.set(x, y, z).applyQuaternion(this.#basketTurn).add(position);
    return { x: at.x, y: at.y, z: at.z };
  }

  #put(ball: number, location: BallLocation, position: Vec3, time: number): void {
    this.#setTurn(ball, location, position, time);
    this.#setMatrix(ball, this.#matrix.compose(this.#at.copy(position), this.#turn, one));
    if (location.on === 'air' || location.on === 'floor') this.#shadows.put(ball, position);
    else this.#shadows.hide(ball);
  }

  #hide(ball: number): void {
    this.#setMatrix(ball, gone);
    this.#shadows.hide(ball);
  }

  #setMatrix(ball: number, matrix: Matrix4): void {
    this.#meshes[ball < this.#perRack ? 0 : 1].setMatrixAt(ball % this.#perRack, matrix);
  }

  /** Rotates a ball. Each resting ball has its own rotation; a moving one turns around the axis across its path. */
  #setTurn(ball: number, location: BallLocation, position: Vec3, time: number): void {
    const axis = this.#axis;
    this.#turn.setFromAxisAngle(axis.set(0.6, 0.2, 0.77).normalize(), ball * 1.9);
    if (location.on !== 'air' && location.on !== 'floor') return;
    const { velocity } = location.launch;
    axis.set(velocity.z, 0, -velocity.x);
    if (axis.lengthSq() < 1e-6) return;
    const angle = turnedBy(location.on, location.launch, time, position);
    this.#turn.premultiply(this.#rolled.setFromAxisAngle(axis.normalize(), angle));
  }
}
