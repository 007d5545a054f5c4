import type { VRM, VRMHumanBoneName } from '@pixiv/three-vrm';
import { Bone, Matrix4, type Object3D, Quaternion, Vector3 } from 'three';
import { type JointName, jointNames, parentOf } from '../../core/body/joints';
import { copyQuat, fromAxisAngle, type MutableQuat, multiply, type Quat, quat } from '../../core/math/quat';
import { copyVec3, distance, type MutableVec3, up, type Vec3, vec3 } from '../../core/math/vec3';

export const legJoints = [
  'leftUpperLeg',
  'leftLowerLeg',
  'leftFoot',
  'rightUpperLeg',
  'rightLowerLeg',
  'rightFoot',
] as const;
type LegJoint = (typeof legJoints)[number];
export type AvatarJoint = JointName | LegJoint;

export interface RigBone {
  readonly node: Object3D;
  readonly parent: RigBone | null;
  /** The rest pose in the rig's own frame, facing +Z. */
  readonly restRotation: Quaternion;
  readonly restPosition: Vector3;
  /**
   * The matrix of the node's parent, which need not be a bone, in the frame of the parent bone at rest (or of the rig).
   */
  readonly fromParentBone: Matrix4;
  /** The scale of the node's ancestors in the file (centimetres, a mirror), in the frame of the node. */
  readonly restScale: Matrix4;
  /** The stretch along the bone, in its own frame, times the scales of rig and file. */
  readonly stretch: Matrix4;
  /** The unit direction to the bone's end in its own frame, and the bone's length [m] on the scaled rig. */
  readonly direction: Vector3;
  ownLength: number;
  /** The world matrix in this frame. */
  readonly world: Matrix4;
  /** Whether a pose has set `world`; otherwise the bone keeps its pose relative to its parent. */
  placed: boolean;
  /** The drawn position in this frame, floor frame [m]. */
  readonly drawn: MutableVec3;
  /** The rotation from T-pose with which the bone was placed last, floor frame. */
  readonly turn: MutableQuat;
}

/** An added joint at the origin of a bone, with the bone's stretch and another rotation. */
export interface HelperJoint {
  readonly base: RigBone;
  readonly node: Bone;
}

/** The bone whose origin is the end of another, by which its length is measured. */
const farEnd: Partial<Record<AvatarJoint, AvatarJoint>> = {
  leftUpperLeg: 'leftLowerLeg',
  leftLowerLeg: 'leftFoot',
  rightUpperLeg: 'rightLowerLeg',
  rightLowerLeg: 'rightFoot',
};
for (const joint of jointNames) {
  const parent = parentOf[joint];
  if (parent) farEnd[parent] ??= joint;
}

const drivenJoints: readonly AvatarJoint[] = [...jointNames, ...legJoints];

const trunkBones: ReadonlySet<string> = new Set([
  'hips',
  'spine',
  'chest',
  'upperChest',
  'neck',
  'leftShoulder',
  'rightShoulder',
]);

/** The rotation from a VRM at rest, facing +Z, to the T-pose facing −Z. */
const ourFacing: Quat = fromAxisAngle(up, Math.PI);
/** The limits of a bone's stretch [fraction of its length]. */
const maxStretch = 3;
const minStretch = 0.3;

const unitScale = new Vector3(1, 1, 1);
const scaling = new Vector3();
const position = new Vector3();
const rotation = new Quaternion();
const above = new Matrix4();
const helperWorld = new Matrix4();
const facing = quat(0, 0, 0, 1);

/** The bones of a VRM that poses move. Each bone is placed separately, not by a chain of rotations. */
export class Rig {
  readonly bones: ReadonlyMap<AvatarJoint, RigBone>;
  /** The nodes of added joints. Each is at the origin of its bone, whose child it is. */
  readonly helpers = new Set<Object3D>();
  /** The bones with ancestors first: files may hang the hips under the spine. */
  private readonly ordered: readonly RigBone[];
  /** Joints of the bones as drawn, floor frame [m]; the same object in every frame. */
  readonly joints: Partial<Record<AvatarJoint, Vec3>> = {};
  /** Whether the file has constraints, which read positions and rotations; drawing needs only matrices. */
  private readonly constrained: boolean;
  /** The scale from the rig at rest to the body. */
  private scale = 1;

  constructor(vrm: VRM) {
    this.bones = readRig(vrm);
    this.ordered = [...this.bones.values()].sort((a, b) => depthOf(a) - depthOf(b));
    this.constrained = (vrm.nodeConstraintManager?.constraints.size ?? 0) > 0;
    for (const { node } of this.bones.values()) node.matrixAutoUpdate = false;
  }

  /** Returns the joint at rest in the rig's own frame, facing +Z; null: the rig has no such bone. */
  rest(name: AvatarJoint): Vector3 | null {
    return this.bones.get(name)?.restPosition ?? null;
  }

  /**
   * Scales the rig by `scale` and stretches each bone to its length [m] in `joints` (a T-pose), legs to `legs`; other
   * lengths stay the rig's own.
   */
  fit(
    joints: Readonly<Record<JointName, { readonly position: Vec3 }>>,
    legs: { readonly upper: number; readonly lower: number },
    scale: number,
  ): void {
    this.scale = scale;
    for (const [name, bone] of this.bones) {
      const { restPosition, restRotation, direction } = bone;
      const end = farEnd[name];
      const endPosition = end && this.rest(end);
      bone.ownLength = endPosition ? restPosition.distanceTo(endPosition) * scale : 0;
      if (endPosition) {
        direction
          .subVectors(endPosition, restPosition)
          .normalize()
          .applyQuaternion(rotation.copy(restRotation).invert());
      }
      const wanted =
        end && name in joints && end in joints
          ? distance(joints[name as JointName].position, joints[end as JointName].position)
          : name.endsWith('UpperLeg')
            ? legs.upper
            : name.endsWith('LowerLeg')
              ? legs.lower
              : bone.ownLength;
      // Vertebrae are short and differ between rigs: they are moved apart instead of stretched, which would tear the
      // skin.
      this.reach(name, trunkBones.has(name) ? bone.ownLength : wanted);
    }
  }

  /** Stretches a bone to this length [m], within the limits. */
  reach(name: AvatarJoint, length: number): void {
    const bone = this.bones.get(name);
    if (!bone) return;
    const { stretch, direction, ownLength, restScale } = bone;
    const factor = ownLength <= 1e-4 ? 1 : Math.min(maxStretch, Math.max(minStretch, length / ownLength));
    setStretch(stretch, direction, factor, this.scale).multiply(restScale);
  }

  /**
   * Moves a bone to a joint: position [m] and rotation from T-pose, floor frame. Does nothing where the rig lacks the
   * bone. `seen`: whether it counts among the drawn joints. The nodes move with the next `settle`.
   */
  place(name: AvatarJoint, at: Vec3, rotationFromRest: Quat, seen = true): void {
    const bone = this.bones.get(name);
    if (!bone) return;
    setWorld(bone, at, rotationFromRest, bone.world);
    bone.placed = true;
    copyVec3(at, bone.drawn);
    copyQuat(rotationFromRest, bone.turn);
    if (seen) this.joints[name] = bone.drawn;
  }

  /** Moves the nodes to where their bones were placed, ancestors first. */
  settle(): void {
    for (let i = 0; i < this.ordered.length; i++) {
      const { node, parent, world, fromParentBone, placed } = this.ordered[i]!;
      // Nodes between the parent bone and this node, and above the topmost bones, keep their rest pose.
      if (parent) above.multiplyMatrices(parent.world, fromParentBone);
      else above.copy(fromParentBone);
      if (placed) {
        node.matrix.multiplyMatrices(above.invert(), world);
        if (this.constrained) node.matrix.decompose(node.position, node.quaternion, node.scale);
      } else world.multiplyMatrices(above, node.matrix);
      node.matrixWorldNeedsUpdate = true;
    }
  }

  /** Adds a joint to a bone. Throws if the rig lacks the bone. */
  addHelper(name: AvatarJoint, what: string): HelperJoint {
    const base = this.bones.get(name);
    if (!base) throw new Error(`avatar/rig: a rig without ${name}`);
    const node = new Bone();
    node.name = `${name} ${what}`;
    node.matrixAutoUpdate = false;
    base.node.add(node);
    this.helpers.add(node);
    node.updateMatrixWorld(true);
    return { base, node };
  }

  /** Places a helper joint as `place` does a bone; its bone must have been placed before. */
  placeHelper({ base, node }: HelperJoint, at: Vec3, rotationFromRest: Quat): void {
    setWorld(base, at, rotationFromRest, helperWorld);
    node.matrix.multiplyMatrices(above.copy(base.world).invert(), helperWorld);
    node.matrixWorldNeedsUpdate = true;
  }

  /** Aligns a helper joint with its bone. */
  straighten({ node }: HelperJoint): void {
    node.matrix.identity();
    node.matrixWorldNeedsUpdate = true;
  }

  /** Scales a bone to zero, so that its skin is not drawn. */
  shrink(name: AvatarJoint): void {
    const bone = this.bones.get(name);
    if (!bone) return;
    bone.placed = false;
    bone.node.matrix.makeScale(1e-6, 1e-6, 1e-6);
    delete this.joints[name];
  }

  forgetJoints(): void {
    for (const name of this.bones.keys()) delete this.joints[name];
  }
}

/** Writes the world matrix of a bone with this position and rotation. */
function setWorld(bone: RigBone, at: Vec3, rotationFromRest: Quat, target: Matrix4): void {
  rotation.copy(multiply(rotationFromRest, ourFacing, facing)).multiply(bone.restRotation);
  target.compose(position.copy(at), rotation, unitScale).multiply(bone.stretch);
}

/** Writes uniform·(1 + (factor − 1)·d·dᵀ), a stretch along the direction d. */
function setStretch(target: Matrix4, d: Vector3, factor: number, uniform: number): Matrix4 {
  const k = factor - 1;
  target.set(
    1 + k * d.x * d.x, k * d.x * d.y, k * d.x * d.z, 0,
    k * d.x * d.y, 1 + k * d.y * d.y, k * d.y * d.z, 0,
    k * d.x * d.z, k * d.y * d.z, 1 + k * d.z * d.z, 0,
    0, 0, 0, 1,
  ); // biome-ignore format: a matrix
  return target.scale(scaling.setScalar(uniform));
}

function depthOf({ node }: RigBone): number {
  let depth = 0;
  for (let above = node.parent; above; above = above.parent) depth += 1;
  return depth;
}

function readRig(vrm: VRM): Map<AvatarJoint, RigBone> {
  const bones = new Map<AvatarJoint, RigBone>();
  const driven = drivenJoints.flatMap((name) => {
    const node = vrm.humanoid.getRawBoneNode(name as VRMHumanBoneName);
    return node ? [[node, name] as const] : [];
  });
  const nodes = new Map(driven);
  const boneOf = (node: Object3D, name: AvatarJoint): RigBone => {
    const known = bones.get(name);
    if (known) return known;
    let above: Object3D | null = node.parent;
    while (above && !nodes.has(above)) above = above.parent;
    const parent = above && boneOf(above, nodes.get(above)!);
    const actualParent = node.parent?.matrixWorld ?? new Matrix4();
    const restRotation = node.getWorldQuaternion(new Quaternion());
    const target: RigBone = {
      node,
      parent,
      restRotation,
      restPosition: node.getWorldPosition(new Vector3()),
      restScale: new Matrix4()
        .makeRotationFromQuaternion(restRotation)
        .invert()
        .multiply(node.matrixWorld)
        .setPosition(0, 0, 0),
      direction: new Vector3(0, 1, 0),
      ownLength: 0,
      fromParentBone: parent ? parent.node.matrixWorld.clone().invert().multiply(actualParent) : actualParent.clone(),
      stretch: new Matrix4(),
      world: new Matrix4(),
      placed: false,
      drawn: vec3(0, 0, 0),
      turn: quat(0, 0, 0, 1),
    };
    bones.set(name, target);
    return target;
  };
  for (const [node, name] of driven) boneOf(node, name);
  return bones;
}
