import { type Object3D, type SkinnedMesh, Vector3 } from 'three';
import type { MutableJointPoses } from '../../core/body/forward-kinematics';
import { fromAxisAngle, multiply, quat, rotate } from '../../core/math/quat';
import {
  add,
  addScaled,
  copyVec3,
  dot,
  forward,
  length,
  normalise,
  right,
  subtract,
  type Vec3,
  vec3,
} from '../../core/math/vec3';
import { skinnedMeshesOf, verticesMovedBy } from '../scene-meshes';
import type { Rig } from './rig';

/** The part of a trunk that is measured [fraction of the way from the hips to the neck], in so many slices. */
const lowest = -0.3;
const highest = 1.1;
const slices = 24;
/** The directions in which a slice is measured, a turn in equal steps. */
const directions = Array.from({ length: 16 }, (_, k) => {
  const angle = (k * 2 * Math.PI) / 16;
  return { right: Math.cos(angle), ahead: Math.sin(angle) };
});
/** Skin counts to the trunk that moves with its bones by more than this share. */
const trunkShare = 0.7;
/** Half the thickness of an arm at the elbow [m]. */
const armRadius = 0.03;
/** The angles by which an arm is turned to leave the trunk: multiples of a step [rad], refined by halving. */
const turnStep = Math.PI / 12;
const halvings = 6;

const trunkNames = ['hips', 'spine', 'chest', 'upperChest'] as const;

// Scratch variables of one call.
const line = vec3(0, 0, 0);
const from = vec3(0, 0, 0);
const toRight = vec3(0, 0, 0);
const toFront = vec3(0, 0, 0);
const axis = vec3(0, 0, 0);
const upperArm = vec3(0, 0, 0);
const elbow = vec3(0, 0, 0);
const turn = quat(0, 0, 0, 1);

/**
 * The skin of a rig's trunk, out of which it keeps elbows. A slice level with the floor at rest has its extent in
 * sixteen directions, so that the shape is the convex hull of each slice.
 */
export class TrunkShape {
  /** Extents from the line of hips and neck [m of the rig at rest]; −∞: no skin. */
  private readonly extents = new Float64Array(slices * directions.length).fill(Number.NEGATIVE_INFINITY);
  private scale = 1;

  constructor(
    scene: Object3D,
    private readonly rig: Rig,
  ) {
    const bones = new Set(trunkNames.flatMap((name) => rig.bones.get(name)?.node ?? []));
    for (const mesh of skinnedMeshesOf(scene)) this.measure(mesh, bones);
  }

  /** Sets the scale of the rig. */
  fit(scale: number): void {
    this.scale = scale;
  }

  /**
   * Turns the arms of a pose, floor frame, about the lines from shoulder to hand until their elbows are outside. Hands
   * stay. An arm that cannot leave the trunk gets the furthest way out.
   */
  keepOut(joints: MutableJointPoses): void {
    this.keepArmOut(joints, joints.leftUpperArm, joints.leftLowerArm, joints.leftHand.position);
    this.keepArmOut(joints, joints.rightUpperArm, joints.rightLowerArm, joints.rightHand.position);
  }

  private keepArmOut(
    joints: MutableJointPoses,
    upper: MutableJointPoses['leftUpperArm'],
    lower: MutableJointPoses['leftLowerArm'],
    hand: Vec3,
  ): void {
    const inside = this.distanceTo(lower.position, joints);
    if (inside >= armRadius) return;
    subtract(hand, upper.position, axis);
    if (length(axis) < 1e-3) return;
    normalise(axis, right, axis);
    subtract(lower.position, upper.position, upperArm);
    const shoulder = upper.position;
    const sign = this.distanceAt(0.01, shoulder, joints) >= this.distanceAt(-0.01, shoulder, joints) ? 1 : -1;
    let best = 0;
    let furthest = inside;
    for (let step = 1; step <= Math.PI / turnStep && furthest < armRadius; step++) {
      const angle = sign * step * turnStep;
      const far = this.distanceAt(angle, shoulder, joints);
      if (far <= furthest) continue;
      best = angle;
      furthest = far;
    }
    let near = best - sign * turnStep;
    for (let i = 0; i < halvings && furthest >= armRadius; i++) {
      const middle = (near + best) / 2;
      if (this.distanceAt(middle, shoulder, joints) >= armRadius) best = middle;
      else near = middle;
    }
    this.distanceAt(best, shoulder, joints);
    copyVec3(elbow, lower.position);
    multiply(turn, upper.orientation, upper.orientation);
    multiply(turn, lower.orientation, lower.orientation);
  }

  /** Turns the arm in the scratch variables by an angle [rad]; returns how far its elbow is outside [m]. */
  private distanceAt(angle: number, shoulder: Vec3, joints: MutableJointPoses): number {
    add(shoulder, rotate(fromAxisAngle(axis, angle, turn), upperArm, elbow), elbow);
    return this.distanceTo(elbow, joints);
  }

  /** Returns how far a point is outside of the trunk of a pose [m]; negative: inside. */
  private distanceTo(point: Vec3, { hips, neck, chest }: MutableJointPoses): number {
    subtract(neck.position, hips.position, line);
    subtract(point, hips.position, from);
    const height = dot(from, line) / dot(line, line);
    const slice = ((height - lowest) / (highest - lowest)) * (slices - 1);
    if (!(slice >= 0 && slice < slices - 1)) return Number.POSITIVE_INFINITY;
    addScaled(from, line, -height, from);
    const x = dot(from, rotate(chest.orientation, right, toRight));
    const z = dot(from, rotate(chest.orientation, forward, toFront));
    const below = Math.floor(slice) * directions.length;
    const above = slice - Math.floor(slice);
    let furthest = Number.NEGATIVE_INFINITY;
    for (let k = 0; k < directions.length; k++) {
      const way = directions[k]!;
      const [a, b] = [this.extents[below + k]!, this.extents[below + directions.length + k]!];
      // A slice without skin has no trunk, and a slice beside it is taken as it is.
      const extent = a === Number.NEGATIVE_INFINITY ? b : b === Number.NEGATIVE_INFINITY ? a : a + (b - a) * above;
      furthest = Math.max(furthest, x * way.right + z * way.ahead - extent * this.scale);
    }
    return furthest;
  }

  /** Measures the trunk's triangles along their edges. */
  private measure(mesh: SkinnedMesh, bones: ReadonlySet<Object3D>): void {
    const { geometry } = mesh;
    const vertices = verticesMovedBy(mesh, bones, trunkShare);
    if (vertices.length === 0) return;
    const corners = geometry.index!;
    const [start, end] = [this.rig.rest('hips')!, this.rig.rest('neck') ?? this.rig.rest('head')!];
    const way = end.clone().sub(start);
    // The slice of a vertex that is no part of the trunk stays NaN.
    const places = new Float64Array(3 * geometry.getAttribute('position').count).fill(Number.NaN);
    const place = new Vector3();
    for (const vertex of vertices) {
      mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld).sub(start);
      const height = place.dot(way) / way.lengthSq();
      place.addScaledVector(way, -height);
      // The rig faces +Z at rest: its right is −X.
      places[3 * vertex] = ((height - lowest) / (highest - lowest)) * (slices - 1);
      places[3 * vertex + 1] = -place.x;
      places[3 * vertex + 2] = place.z;
    }
    for (let corner = 0; corner < corners.count; corner++) {
      const first = 3 * corners.getX(corner);
      const second = 3 * corners.getX(corner % 3 === 2 ? corner - 2 : corner + 1);
      if (!Number.isNaN(places[first]! + places[second]!)) this.addEdge(places, first, second);
    }
  }

  /** Adds an edge [slice, right, ahead] to the slices that it crosses, and its first corner to the nearest. */
  private addEdge(places: Float64Array, first: number, second: number): void {
    const [a, b] = [places[first]!, places[second]!];
    this.addPoint(Math.round(a), places[first + 1]!, places[first + 2]!);
    for (let slice = Math.ceil(Math.min(a, b)); slice <= Math.max(a, b); slice++) {
      const share = a === b ? 0 : (slice - a) / (b - a);
      const x = places[first + 1]! + share * (places[second + 1]! - places[first + 1]!);
      this.addPoint(slice, x, places[first + 2]! + share * (places[second + 2]! - places[first + 2]!));
    }
  }

  private addPoint(slice: number, x: number, z: number): void {
    if (!(slice >= 0 && slice < slices)) return;
    for (let k = 0; k < directions.length; k++) {
      const at = slice * directions.length + k;
      const way = directions[k]!;
      this.extents[at] = Math.max(this.extents[at]!, x * way.right + z * way.ahead);
    }
  }
}
