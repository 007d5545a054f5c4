import { type VRM, type VRMHumanBoneName, VRMUtils } from '@pixiv/three-vrm';
import {
  Color,
  Group,
  type Material,
  Matrix4,
  type Mesh,
  MeshStandardMaterial,
  type Object3D,
  Quaternion,
  SkinnedMesh,
  Vector3,
} from 'three';
import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import { forwardKinematics } from '../core/body/forward-kinematics';
import { type JointName, jointNames, type Side } from '../core/body/joints';
import { type Skeleton, sideSign, skeletonFromCalibration } from '../core/body/skeleton';
import { solveTwoBones } from '../core/body/two-bone-ik';
import type { Pose } from '../core/math/pose';
import { fromAxisAngle, multiply, type Quat, rotate } from '../core/math/quat';
import { add, distance, normalise, scale, subtract, up, type Vec3, vec3 } from '../core/math/vec3';
import type { LoadedAvatar } from './load-avatar';
import { palettes } from './palettes';
import { type SkinPart, sortByPart } from './skin-parts';
import { createStepping } from './stepping';

/** The layer of what only others and mirrors see: the own head. VRM's own number for it. */
export const thirdPersonOnlyLayer = 10;
const firstPersonOnlyLayer = 9;

export const legJoints = [
  'leftUpperLeg',
  'leftLowerLeg',
  'leftFoot',
  'rightUpperLeg',
  'rightLowerLeg',
  'rightFoot',
] as const;
type LegJoint = (typeof legJoints)[number];
type AvatarJoint = JointName | LegJoint;

/** A body on the screen. Poses are in the floor frame; so is `object`, which stays where it is put: at the floor's origin. */
export interface Avatar {
  readonly object: Object3D;
  /** Scales the rig to this body, limb by limb, whatever its own proportions. May be called again at any time. */
  fitTo(calibration: Calibration): void;
  /** Bends the body to a pose; time [s] on the clock of the tracking frames. */
  apply(pose: AvatarPose, time: number): void;
  /** Hides the own head from the own eyes; mirrors and others still see it. */
  setFirstPerson(on: boolean): void;
  setUpperBodyOnly(on: boolean): void;
  /** Recolours the materials of our mannequin; other avatars keep their own. Unknown names change nothing. */
  setPalette(name: string): void;
  /** 1: solid. Less: a ghost that things behind it shine through. */
  setOpacity(opacity: number): void;
  /** How far each hand's fingers are closed, 0 open to 1 a fist. */
  setGrip(side: Side, closed: number): void;
  /** Where the joints of the bones are drawn, floor frame [m]; only bones that the rig has. */
  jointPositions(): Readonly<Partial<Record<AvatarJoint, Vec3>>>;
  dispose(): void;
}

/** From a VRM at rest, which faces +Z, to our T-pose, which faces −Z. */
const ourFacing: Quat = fromAxisAngle(up, Math.PI);
/** The hand bone of our T-pose in the wrist's frame; see docs/frames.md. */
const wristFromHandBone: Readonly<Record<Side, Quat>> = {
  left: fromAxisAngle(up, -Math.PI / 2),
  right: fromAxisAngle(up, Math.PI / 2),
};
const relaxedCurl = 0.22;

interface RigBone {
  readonly node: Object3D;
  readonly parent: RigBone | null;
  /** The rest pose in the rig's own frame, facing +Z. */
  readonly restRotation: Quaternion;
  readonly restPosition: Vector3;
  /** The node's actual parent, which need not be a human bone, in the frame of the parent bone at rest (or of the rig). */
  readonly fromParentBone: Matrix4;
  /** Stretch along the bone, in its own frame, and the uniform scale of the rig. */
  readonly stretch: Matrix4;
  /** World matrix of this frame. */
  readonly world: Matrix4;
}

const vector = ({ x, y, z }: Vec3): Vector3 => new Vector3(x, y, z);
const quaternion = ({ x, y, z, w }: Quat): Quaternion => new Quaternion(x, y, z, w);

/** The bone whose origin marks the far end of another: what its length is measured to. */
const farEnd: Partial<Record<AvatarJoint, AvatarJoint>> = {
  hips: 'spine',
  spine: 'chest',
  chest: 'upperChest',
  upperChest: 'neck',
  neck: 'head',
  leftShoulder: 'leftUpperArm',
  leftUpperArm: 'leftLowerArm',
  leftLowerArm: 'leftHand',
  rightShoulder: 'rightUpperArm',
  rightUpperArm: 'rightLowerArm',
  rightLowerArm: 'rightHand',
  leftUpperLeg: 'leftLowerLeg',
  leftLowerLeg: 'leftFoot',
  rightUpperLeg: 'rightLowerLeg',
  rightLowerLeg: 'rightFoot',
};

/** Parents before children. */
const drivenJoints: readonly AvatarJoint[] = [...jointNames, ...legJoints];

export function createAvatar({ vrm }: LoadedAvatar): Avatar {
  const object = new Group();
  object.name = 'avatar';
  object.add(vrm.scene);
  vrm.humanoid.resetRawPose();
  vrm.humanoid.autoUpdateHumanBones = false;
  vrm.firstPerson?.setup();
  object.updateMatrixWorld(true);

  const bones = readRig(vrm);
  const bone = (name: AvatarJoint): RigBone | undefined => bones.get(name);
  for (const { node } of bones.values()) node.matrixAutoUpdate = false;
  const fingers = readFingers(vrm);
  const meshes = readMeshes(vrm, bones);
  const stepping = createStepping();
  /** Constraints read positions and rotations; drawing needs the matrices alone. */
  const constrained = (vrm.nodeConstraintManager?.constraints.size ?? 0) > 0;
  const rest = (name: AvatarJoint): Vector3 | null => bone(name)?.restPosition ?? null;

  let skeleton: Skeleton = skeletonFromCalibration({ eyeHeight: 1.59, armSpan: 1.5 });
  /** Rig to body, the same in all directions; limbs add their own stretch. */
  let rigScale = 1;
  let legs = { hip: new Vector3(0.09, -0.06, 0), upper: 0.42, lower: 0.42, ankle: 0.08, halfWidth: 0.1 };
  let upperBodyOnly = false;
  let firstPerson = false;
  let shown: 'body' | 'hands' | 'nothing' = 'nothing';
  let lastTime: number | null = null;
  let drawn: Partial<Record<AvatarJoint, Vec3>> = {};
  let opacity = 1;
  const looks = new Map<Material, { readonly transparent: boolean; readonly opacity: number }>();
  /** As the file has it: hair and glasses are transparent by themselves. */
  function ownLook(material: Material) {
    const { transparent, opacity } = material;
    const look = looks.get(material) ?? { transparent, opacity };
    looks.set(material, look);
    return look;
  }
  const grip: Record<Side, number> = { left: relaxedCurl, right: relaxedCurl };

  /** The joint at rest in our skeleton, facing −Z. */
  function restOf(identityPose: Readonly<Record<JointName, Pose<'floor'>>>, name: AvatarJoint): Vec3 | null {
    return name in identityPose ? identityPose[name as JointName].position : null;
  }

  function fitTo(calibration: Calibration): void {
    skeleton = skeletonFromCalibration(calibration);
    const identity = { x: 0, y: 0, z: 0, w: 1 };
    const tPose = forwardKinematics(skeleton, {
      hipsPosition: skeleton.restOffsets.hips,
      localRotations: Object.fromEntries(jointNames.map((name) => [name, identity])) as Record<JointName, Quat>,
    });
    const headHeight = rest('head')?.y ?? 1.5;
    rigScale = tPose.head.position.y / Math.max(headHeight, 0.1);

    // Legs: the rig's own shares of what is left below the hips.
    const hip = rest('leftUpperLeg');
    const hipsRest = rest('hips') ?? new Vector3(0, 1, 0);
    const knee = rest('leftLowerLeg');
    const ankle = rest('leftFoot');
    if (hip && knee && ankle) {
      const downScale = tPose.hips.position.y / hipsRest.y;
      legs = {
        // The rig faces +Z, we face −Z.
        hip: new Vector3(
          Math.abs(hip.x - hipsRest.x) * rigScale,
          (hip.y - hipsRest.y) * downScale,
          -(hip.z - hipsRest.z) * rigScale,
        ),
        upper: hip.distanceTo(knee) * downScale,
        lower: knee.distanceTo(ankle) * downScale,
        ankle: ankle.y * rigScale,
        halfWidth: Math.abs(ankle.x) * rigScale,
      };
      // The ankle keeps the foot's own size; the rest of the difference goes to the shin.
      legs.lower += ankle.y * (downScale - rigScale);
    }

    for (const [name, { restPosition, restRotation, stretch }] of bones) {
      const end = farEnd[name];
      const endPosition = end && rest(end);
      let factor = 1;
      if (endPosition) {
        const own = restPosition.distanceTo(endPosition) * rigScale;
        const from = restOf(tPose, name);
        const to = end ? restOf(tPose, end) : null;
        const wanted =
          from && to
            ? distance(from, to)
            : name.endsWith('UpperLeg')
              ? legs.upper
              : name.endsWith('LowerLeg')
                ? legs.lower
                : own;
        if (own > 1e-4) factor = Math.min(3, Math.max(0.3, wanted / own));
        // The trunk's vertebrae are short and lie differently in every rig: stretched, they would tear; moved apart, they bend.
        if (trunkBones.has(name)) factor = 1;
      }
      const direction = endPosition
        ? endPosition.clone().sub(restPosition).normalize().applyQuaternion(restRotation.clone().invert())
        : new Vector3(0, 1, 0);
      setStretch(stretch, direction, factor, rigScale);
    }
    stepping.reset();
  }

  /** Puts a bone where a joint of ours is: position [m] and rotation from T-pose, floor frame. */
  function place(name: AvatarJoint, position: Vec3, rotationFromRest: Quat): void {
    const target = bone(name);
    if (!target) return;
    const { node, parent, world, stretch, restRotation, fromParentBone } = target;
    scratchRotation.copy(quaternion(multiply(rotationFromRest, ourFacing))).multiply(restRotation);
    world.compose(vector(position), scratchRotation, unitScale).multiply(stretch);
    // Whatever lies between the parent bone and this node (and above the hips) keeps its rest pose.
    const above = parent
      ? scratchMatrix.copy(parent.world).multiply(fromParentBone)
      : scratchMatrix.copy(fromParentBone);
    node.matrix.copy(above.invert()).multiply(world);
    if (constrained) node.matrix.decompose(node.position, node.quaternion, node.scale);
    node.matrixWorldNeedsUpdate = true;
    drawn[name] = position;
  }

  function applyBody(pose: NonNullable<AvatarPose['body']>, deltaSeconds: number): void {
    const joints = forwardKinematics(skeleton, pose);
    for (const name of jointNames) place(name, joints[name].position, joints[name].orientation);
    applyLegs(joints.hips, deltaSeconds);
  }

  function applyLegs(hips: Pose<'floor'>, deltaSeconds: number): void {
    if (!bone('leftFoot') || !bone('rightFoot')) return;
    const ahead = rotate(hips.orientation, vec3(0, 0, -1));
    const overhead = rotate(hips.orientation, up);
    // Bent over, the pelvis' forward points down and its up points ahead: together they know the way.
    const way = add(
      scale({ ...ahead, y: 0 }, Math.max(0, overhead.y)),
      scale({ ...overhead, y: 0 }, Math.max(0, -ahead.y)),
    );
    const yaw = Math.atan2(-way.x, -way.z);
    const level = fromAxisAngle(up, yaw);
    const feet = stepping.update(
      {
        // Between the hip joints; the spine's lowest point lies behind them.
        pelvis: add(hips.position, rotate(level, vec3(0, 0, legs.hip.z))),
        yaw,
        halfWidth: legs.halfWidth,
        ankleHeight: legs.ankle,
        legLength: legs.upper + legs.lower,
      },
      deltaSeconds,
    );
    for (const side of ['left', 'right'] as const) {
      const sigma = sideSign(side);
      const foot = feet[side];
      // Legs hang from a pelvis that tilts less than the lower back above it.
      const hip = add(hips.position, rotate(level, vec3(sigma * legs.hip.x, legs.hip.y, legs.hip.z)));
      const reach = (legs.upper + legs.lower) * 0.999;
      const toAnkle = subtract(foot.position, hip);
      const far = Math.hypot(toAnkle.x, toAnkle.y, toAnkle.z);
      // A pelvis higher than its legs are long takes the feet off the floor.
      const ankle = far > reach ? add(hip, scale(toAnkle, reach / far)) : foot.position;
      const toes = rotate(fromAxisAngle(up, foot.yaw), vec3(0, 0, -1));
      const forward = rotate(level, vec3(0, 0, -1));
      const pole = normalise(add(toes, forward), forward);
      const { elbow: knee } = solveTwoBones(hip, ankle, legs.upper, legs.lower, pole, [forward, up]);
      place(`${side}UpperLeg`, hip, aimDown(subtract(knee, hip), pole));
      place(`${side}LowerLeg`, knee, aimDown(subtract(ankle, knee), pole));
      place(`${side}Foot`, ankle, multiply(fromAxisAngle(up, foot.yaw), fromAxisAngle(vec3(1, 0, 0), -foot.pitch)));
    }
  }

  /** Head and hands alone, each where it was tracked; the rest is not drawn. */
  function applyHands(pose: AvatarPose): void {
    const { head } = pose;
    const headJoint = subtract(head.position, rotate(head.orientation, skeleton.eyesInHead));
    for (const name of jointNames) place(name, headJoint, head.orientation);
    drawn = { head: headJoint };
    for (const side of ['left', 'right'] as const) {
      const hand = side === 'left' ? pose.leftHand : pose.rightHand;
      if (hand) place(`${side}Hand`, hand.position, multiply(hand.orientation, wristFromHandBone[side]));
      else bone(`${side}Hand`)?.world.makeScale(0, 0, 0);
      const target = bone(`${side}Hand`);
      // A hand nobody sees shrinks to nothing.
      if (target && !hand) target.node.matrix.makeScale(1e-6, 1e-6, 1e-6);
    }
  }

  function showParts(): void {
    const last: SkinPart = shown === 'hands' ? 'head' : upperBodyOnly ? 'trunk' : 'legs';
    for (const { mesh, ends } of meshes) {
      const end = ends?.[last];
      mesh.visible = shown !== 'nothing' && (end === undefined ? shown === 'body' : end > 0);
      if (end !== undefined) mesh.geometry.setDrawRange(0, end);
    }
  }

  function showLayers(): void {
    for (const { mesh, audience } of meshes) {
      if (audience === 'both') mesh.layers.set(0);
      else if (audience === 'others') mesh.layers.set(firstPerson ? thirdPersonOnlyLayer : 0);
      else mesh.layers.set(firstPerson ? 0 : firstPersonOnlyLayer);
    }
  }

  function closeFingers(): void {
    for (const { node, rest: atRest, axis, side, share } of fingers) {
      node.quaternion.copy(atRest).multiply(scratchRotation.setFromAxisAngle(axis, share * grip[side]));
    }
  }

  showParts();
  showLayers();
  closeFingers();
  fitTo({ eyeHeight: 1.59, armSpan: 1.5 });

  return {
    object,
    fitTo,
    apply(pose, time) {
      const deltaSeconds = lastTime === null ? 0 : Math.min(0.25, Math.max(0, time - lastTime));
      lastTime = time;
      drawn = {};
      if (pose.body) applyBody(pose.body, deltaSeconds);
      else applyHands(pose);
      const now = pose.body ? 'body' : 'hands';
      if (now !== shown) {
        shown = now;
        showParts();
      }
      vrm.update(deltaSeconds);
    },
    setFirstPerson(on) {
      if (on === firstPerson) return;
      firstPerson = on;
      showLayers();
    },
    setUpperBodyOnly(on) {
      upperBodyOnly = on;
      showParts();
    },
    setPalette(name) {
      const palette = palettes.find((candidate) => candidate.name === name);
      if (!palette) return;
      const colors: Record<string, string> = {
        Suit: palette.suit,
        Accent: palette.color,
        Head: palette.head,
        Visor: palette.visor,
      };
      for (const { mesh } of meshes) {
        for (const material of materialsOf(mesh)) {
          const color = colors[material.name];
          if (color && material instanceof MeshStandardMaterial) material.color = new Color(color);
        }
      }
    },
    setOpacity(next) {
      if (next === opacity) return;
      opacity = next;
      for (const { mesh } of meshes) {
        for (const material of materialsOf(mesh)) {
          const solid = ownLook(material);
          const transparent = solid.transparent || opacity < 1;
          if (material.transparent !== transparent) {
            material.transparent = transparent;
            material.needsUpdate = true;
          }
          material.opacity = opacity * solid.opacity;
        }
        mesh.castShadow = opacity > 0.5;
      }
    },
    setGrip(side, closed) {
      const next = Math.max(relaxedCurl, Math.min(1, closed));
      if (next === grip[side]) return;
      grip[side] = next;
      closeFingers();
    },
    jointPositions: () => drawn,
    dispose() {
      object.removeFromParent();
      VRMUtils.deepDispose(vrm.scene);
    },
  };
}

const trunkBones: ReadonlySet<string> = new Set([
  'hips',
  'spine',
  'chest',
  'upperChest',
  'neck',
  'leftShoulder',
  'rightShoulder',
]);
const unitScale = new Vector3(1, 1, 1);
const scratchRotation = new Quaternion();
const scratchMatrix = new Matrix4();

/** The rotation that takes a leg hanging down, toes to −Z, along `direction` with its knee towards `pole`. */
function aimDown(direction: Vec3, pole: Vec3): Quat {
  const y = vector(normalise(scale(direction, -1), up));
  const z = vector(pole).negate();
  const x = new Vector3().crossVectors(y, z).normalize();
  z.crossVectors(x, y);
  const { x: qx, y: qy, z: qz, w } = new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, y, z));
  return { x: qx, y: qy, z: qz, w };
}

/** scale·(1 + (factor − 1)·d·dᵀ): longer along a direction only. */
function setStretch(target: Matrix4, d: Vector3, factor: number, uniform: number): void {
  const k = factor - 1;
  target.set(
    1 + k * d.x * d.x, k * d.x * d.y, k * d.x * d.z, 0,
    k * d.x * d.y, 1 + k * d.y * d.y, k * d.y * d.z, 0,
    k * d.x * d.z, k * d.y * d.z, 1 + k * d.z * d.z, 0,
    0, 0, 0, 1,
  ); // biome-ignore format: a matrix
  target.multiply(new Matrix4().makeScale(uniform, uniform, uniform));
}

function readRig(vrm: VRM): Map<AvatarJoint, RigBone> {
  const bones = new Map<AvatarJoint, RigBone>();
  const nodes = new Map<Object3D, RigBone>();
  for (const name of drivenJoints) {
    const node = vrm.humanoid.getRawBoneNode(name as VRMHumanBoneName);
    if (!node) continue;
    let above: Object3D | null = node.parent;
    while (above && !nodes.has(above)) above = above.parent;
    const parent = (above && nodes.get(above)) ?? null;
    const actualParent = node.parent?.matrixWorld ?? new Matrix4();
    const target: RigBone = {
      node,
      parent,
      restRotation: node.getWorldQuaternion(new Quaternion()),
      restPosition: node.getWorldPosition(new Vector3()),
      fromParentBone: parent ? parent.node.matrixWorld.clone().invert().multiply(actualParent) : actualParent.clone(),
      stretch: new Matrix4(),
      world: new Matrix4(),
    };
    nodes.set(node, target);
    bones.set(name, target);
  }
  return bones;
}

interface FingerBone {
  readonly node: Object3D;
  readonly side: Side;
  readonly rest: Quaternion;
  /** In the bone's own frame: the axis about which it closes. */
  readonly axis: Vector3;
  /** Angle [rad] of a closed fist. */
  readonly share: number;
}

function readFingers(vrm: VRM): FingerBone[] {
  const result: FingerBone[] = [];
  for (const side of ['left', 'right'] as const) {
    const sigma = side === 'left' ? 1 : -1;
    for (const finger of ['Thumb', 'Index', 'Middle', 'Ring', 'Little']) {
      const phalanges =
        finger === 'Thumb'
          ? ([
              ['Metacarpal', 0.35],
              ['Proximal', 0.6],
              ['Distal', 0.8],
            ] as const)
          : ([
              ['Proximal', 1.25],
              ['Intermediate', 1.55],
              ['Distal', 1.0],
            ] as const);
      for (const [phalanx, share] of phalanges) {
        const node = vrm.humanoid.getRawBoneNode(`${side}${finger}${phalanx}` as VRMHumanBoneName);
        if (!node) continue;
        // At rest the rig faces +Z, its left fingers along +X, palms down: fingers close about Z, the thumb towards the palm.
        const axis = finger === 'Thumb' ? new Vector3(0.35, sigma, 0).normalize() : new Vector3(0, 0, -sigma);
        const world = node.getWorldQuaternion(new Quaternion());
        result.push({ node, side, rest: node.quaternion.clone(), axis: axis.applyQuaternion(world.invert()), share });
      }
    }
  }
  return result;
}

interface AvatarMesh {
  readonly mesh: Mesh;
  readonly audience: 'both' | 'others' | 'self';
  /** Index count up to and including each part; null for meshes without a skin. */
  readonly ends: Record<SkinPart, number> | null;
}

function readMeshes(vrm: VRM, bones: Map<AvatarJoint, RigBone>): AvatarMesh[] {
  const partByNode = new Map<Object3D, SkinPart | 'hips'>();
  const hipLine = bones.get('leftUpperLeg')?.restPosition.y ?? 0;
  for (const [name, { node }] of bones) {
    const part: SkinPart | 'hips' =
      name === 'hips'
        ? 'hips'
        : name.endsWith('Hand')
          ? 'hands'
          : name === 'head'
            ? 'head'
            : /Leg$|Foot$/.test(name)
              ? 'legs'
              : 'trunk';
    partByNode.set(node, part);
  }
  const partOfBone = (node: Object3D): SkinPart | 'hips' => {
    for (let above: Object3D | null = node; above; above = above.parent) {
      const part = partByNode.get(above);
      if (part) return part;
    }
    return 'trunk';
  };
  const result: AvatarMesh[] = [];
  vrm.scene.traverse((node) => {
    if (!('isMesh' in node)) return;
    const mesh = node as Mesh;
    // Bones carry the skin far from where it lay at rest: its own bounds say nothing.
    mesh.frustumCulled = false;
    mesh.castShadow = true;
    const audience = mesh.layers.isEnabled(0)
      ? 'both'
      : mesh.layers.isEnabled(firstPersonOnlyLayer)
        ? 'self'
        : 'others';
    const ends = mesh instanceof SkinnedMesh ? sortByPart(mesh, partOfBone, hipLine) : null;
    result.push({ mesh, audience, ends });
  });
  return result;
}

function materialsOf(mesh: Mesh): Material[] {
  return Array.isArray(mesh.material) ? mesh.material : [mesh.material];
}
