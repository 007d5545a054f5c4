import { type VRM, VRMFirstPerson, type VRMHumanBoneName, VRMUtils } from '@pixiv/three-vrm';
import { Group, type Object3D } from 'three';
import { handBoneRotation } from '../core/body/arm-rotations';
import type { AvatarPose, UpperBodyPose } from '../core/body/avatar-pose';
import type { SkinTone } from '../core/body/built-in-bodies';
import type { Calibration } from '../core/body/calibration';
import { createJointPoses, forwardKinematics } from '../core/body/forward-kinematics';
import { type HandGeometry, scaledHand } from '../core/body/hand-geometry';
import type { FingerName, HandShape } from '../core/body/hand-shape';
import { headJointOf } from '../core/body/head-joint';
import { type JointName, jointNames } from '../core/body/joints';
import { averageSkeleton, type Skeleton } from '../core/body/skeleton';
import type { GaitPoints } from '../core/estimation/gait/gait-features';
import type { BoneName } from '../core/humanoid/bones';
import { identity, quat, rotate } from '../core/math/quat';
import { type Side, sides } from '../core/math/side';
import { addScaled, setVec3, subtract, type Vec3, vec3 } from '../core/math/vec3';
import { finishWork } from '../core/motion/work';
import { type Mutable, recordOf } from '../core/records';
import { Attachments } from './attachments';
import { betweenFrames, type Steps } from './between-frames';
import { Face } from './face';
import { HandFingers } from './hands/hand-fingers';
import { IdleMotion } from './idle-motion';
import { Legs } from './legs/legs';
import type { LoadedAvatar } from './load-avatar';
import { ArmHelperJoints } from './rig/arm-helpers';
import { type AvatarMesh, BodyMeshes, readMeshes } from './rig/body-meshes';
import type { ClothWeave } from './rig/cloth-weave';
import type { MeshSimplifier } from './rig/distant-triangles';
import { mergeFlatParts } from './rig/flat-parts';
import { tieLooseParts } from './rig/loose-parts';
import { type AvatarJoint, Rig } from './rig/rig';
import { RigTrunk } from './rig/rig-trunk';
import { spreadLimbs } from './rig/spread-limb-weights';
import { Springs } from './rig/springs';
import { TrunkShape } from './rig/trunk-shape';
import { meshesOf } from './scene-meshes';

/**
 * A drawn body. Poses are in the floor frame; `object` stays at the floor's origin.
 *
 * @example
 * const avatar = await loadAvatar('/avatars/me.vrm');
 * avatar.setCalibration(calibration);
 * avatar.setPose(pose, time);
 */
export interface Avatar {
  readonly object: Object3D;
  /** The loaded VRM; of another humanoid, one that was made from its bones. Poses move its bones and its face. */
  readonly vrm: VRM;
  /** The height of the head's top when the body stands upright [m]. */
  readonly height: number;
  /** What was assumed of its file, a sentence each. */
  readonly notes: readonly string[];
  /** Scales the rig limb by limb to these measures, not by its own proportions. May be called at any time. */
  setCalibration(calibration: Calibration): void;
  /**
   * Bends the body to a pose, and the fingers where the pose has them. time: [s], on the clock of the tracking frames.
   */
  setPose(pose: AvatarPose, time: number): void;
  /** Hides the avatar's head from its user's eyes; mirrors and other people still see it. */
  setFirstPerson(on: boolean): void;
  setUpperBodyOnly(on: boolean): void;
  /**
   * Returns the node of a bone by its name in VRM, as drawn; null: the rig has none. Its matrix contains the stretch to
   * the measures: `attach` carries objects unscaled.
   */
  getBone(name: BoneName): Object3D | null;
  /**
   * Carries an object along with a joint, unscaled; `object.removeFromParent()` takes it off. In a hand its axes are
   * the wrist's: −Z to the knuckles, +Y out of the back of the hand. Elsewhere they are the body's in a T-pose: −Z
   * ahead, +Y up. It is hidden with its joint, and the page disposes of it.
   *
   * @example
   * avatar.attach(sword, 'rightHand');
   */
  attach(object: Object3D, joint: JointName): void;
  /**
   * Recolours the clothes of the project's own bodies; null: in their own colours. Other avatars keep theirs. Unknown
   * names change nothing.
   *
   * @internal
   */
  setPalette(name: string | null): void;
  /**
   * Recolours the skin of the project's own people; null: unchanged.
   *
   * @internal
   */
  setSkinTone(tone: SkinTone | null): void;
  /**
   * Draws the clothes of the project's own people with a weave (`weaveCloth`), which is visible from about 1.2 m on;
   * null: smooth, as at first. It is computed in the program that draws them, and costs time for each pixel. Other
   * avatars stay unchanged.
   *
   * @internal
   */
  setClothWeave(weave: ClothWeave | null): void;
  /**
   * Draws the body with fewer triangles in shadows, and for cameras more than 3.5 m from its hips, where the difference
   * is less than a pixel of a headset. Works between frames. Call it before the first `setPose`: edges stay where the
   * body bends. simplifier: the `MeshoptSimplifier` of meshoptimizer, once it is ready.
   *
   * @internal
   */
  simplifyAtDistance(simplifier: MeshSimplifier): Promise<void>;
  /** Sets the opacity: 1 is solid, less a ghost that objects behind it shine through. */
  setOpacity(opacity: number): void;
  /**
   * Sets the opening of the mouth from the next `setPose` on: 0 shut to 1. A body without a shape for it keeps it shut.
   */
  setMouth(open: number): void;
  /**
   * Sets what the eyes turn to from the next `setPose` on, floor frame [m], while it is less than 38° from where the
   * face points; the place is copied. null: they look ahead.
   */
  setGaze(target: Vec3 | null): void;
  /**
   * Lets the drawn body breathe and shift its weight by a few millimetres from the next `setPose` on; default: it does
   * not. Head, elbows, hands and standing feet stay where the pose has them.
   */
  setIdleMotion(on: boolean): void;
  /**
   * Sets the bend of a hand's fingers for poses that have none, from the next `setPose` on; the shape is copied. null:
   * not seen, they keep their bend for a while and relax.
   */
  setFingers(side: Side, shape: HandShape | null): void;
  /**
   * Returns the geometry of the drawn hand [m]; null: the rig lacks a finger bone. The object is the same until the
   * calibration changes.
   *
   * @internal
   */
  handGeometry(side: Side): HandGeometry | null;
  /**
   * Returns the drawn fingertips of the rig, floor frame [m], in new objects for tools.
   *
   * @internal
   */
  fingertips(side: Side): Readonly<Partial<Record<FingerName, Vec3>>>;
  /**
   * Returns the drawn joint positions of the rig's bones, floor frame [m]. The next frame overwrites the object: copy
   * what must stay.
   */
  jointPositions(): Readonly<Partial<Record<AvatarJoint, Vec3>>>;
  dispose(): void;
}

/** The measures of an avatar before `setCalibration`. */
const averageBody: Calibration = { eyeHeight: 1.59, armSpan: 1.5 };
/** The longest time step [s]: feet move no further after a pause of the page. */
const longestStep = 0.25;
const upright = recordOf(jointNames, () => identity);

interface AvatarParts extends Pick<LoadedAvatar, 'vrm' | 'notes'> {
  readonly object: Group;
  readonly rig: Rig;
  readonly arms: ArmHelperJoints;
  readonly legs: Legs;
  readonly meshes: readonly AvatarMesh[];
}

/** Creates an avatar from a file; a loaded file can be used once. */
function* makeAvatar({ vrm, notes, gait }: LoadedAvatar): Steps<Avatar> {
  const object = new Group();
  object.name = 'avatar';
  object.add(vrm.scene);
  vrm.humanoid.autoUpdateHumanBones = false;
  yield* mergeFlatParts(vrm);
  object.updateMatrixWorld(true);
  const rig = new Rig(vrm);
  yield* tieLooseParts(vrm, rig);
  const arms = new ArmHelperJoints(rig);
  const legs = new Legs(rig, gait);
  yield* spreadLimbs(vrm.scene, [...arms.limbs(), ...legs.limbs()]);
  // The first-person meshes are cut from copies of meshes with a head, after the skin weights were shared.
  yield* setUpFirstPerson(vrm);
  const meshes = yield* readMeshes(vrm, rig);
  yield;
  return new VrmAvatar({ vrm, notes, object, rig, arms, legs, meshes });
}

/**
 * Prepares the meshes for first person, mesh by mesh. A file without annotations, as VRM 0.x may be, has its head
 * hidden.
 */
function* setUpFirstPerson({ firstPerson, humanoid, scene }: VRM): Steps<void> {
  const unnamed = () => [{ meshes: meshesOf(scene), type: 'auto' as const }];
  for (const { meshes, type } of firstPerson?.meshAnnotations ?? unnamed()) {
    for (const mesh of meshes) {
      // A primitive that was merged with its siblings has left the scene.
      if (!mesh.parent) continue;
      yield;
      new VRMFirstPerson(humanoid, [{ meshes: [mesh], type }]).setup();
    }
  }
}

class VrmAvatar implements Avatar {
  readonly object: Group;
  readonly notes: readonly string[];
  readonly vrm: VRM;
  private readonly rig: Rig;
  private readonly attachments: Attachments;
  private readonly idle: IdleMotion;
  private readonly trunk: RigTrunk;
  private readonly trunkShape: TrunkShape;
  private readonly arms: ArmHelperJoints;
  private readonly legs: Legs;
  private readonly fingers: Readonly<Record<Side, HandFingers>>;
  private readonly meshes: BodyMeshes;
  private readonly springs: Springs;
  private readonly face: Face;
  private skeleton: Skeleton = averageSkeleton(averageBody);
  private scale = 1;
  private lastTime: number | null = null;
  private readonly joints = createJointPoses();
  /** The points of a pose that the legs follow. */
  private readonly points: Mutable<GaitPoints> = {
    hips: this.joints.hips,
    head: this.joints.head,
    leftHand: this.joints.leftHand.position,
    rightHand: this.joints.rightHand.position,
  };
  private readonly headJoint = vec3(0, 0, 0);
  private readonly hands: Record<Side, HandGeometry | null> = { left: null, right: null };
  private readonly handBone = quat(0, 0, 0, 1);
  private readonly joint = vec3(0, 0, 0);

  constructor({ vrm, notes, object, rig, arms, legs, meshes }: AvatarParts) {
    this.vrm = vrm;
    this.notes = notes;
    this.object = object;
    this.rig = rig;
    this.attachments = new Attachments(object, rig);
    this.arms = arms;
    this.trunk = new RigTrunk(this.rig);
    this.trunkShape = new TrunkShape(vrm.scene, this.rig);
    this.legs = legs;
    this.fingers = recordOf(sides, (side) => new HandFingers(vrm, side));
    this.meshes = new BodyMeshes(meshes, this.rig);
    this.springs = new Springs(vrm);
    // The object's number differs from that of every other avatar, and so do the times at which it blinks and breathes.
    this.face = new Face(vrm, object.id);
    this.idle = new IdleMotion(object.id);
    this.setCalibration(averageBody);
  }

  get height(): number {
    return this.meshes.top * this.scale;
  }

  setCalibration(calibration: Calibration): void {
    this.skeleton = averageSkeleton(calibration);
    const hipsPosition = this.skeleton.restOffsets.hips;
    const tPose = forwardKinematics(this.skeleton, { hipsPosition, localRotations: upright });
    // Rig to body, the same in all directions; limbs add their own stretch.
    this.scale = tPose.head.position.y / (this.rig.rest('head')?.y ?? 1.5);
    this.trunk.fit(tPose, this.scale);
    this.trunkShape.fit(this.scale);
    const hipsHeight = tPose.hips.position.y;
    const legs = this.legs.fit(calibration.eyeHeight, hipsHeight, this.scale, this.trunk.hipsFraction);
    this.rig.fit(tPose, legs, this.scale);
    // The file's own size is what its scene was before it was settled.
    for (const side of sides) {
      const own = this.fingers[side].geometry;
      this.hands[side] = own && scaledHand(own, this.scale);
    }
    this.springs.scaleTo(this.scale * Math.abs(this.vrm.scene.scale.x));
  }

  setPose(pose: AvatarPose, time: number): void {
    const elapsed = this.lastTime === null ? 0 : time - this.lastTime;
    // Written so that a time that is no number is no step.
    const deltaSeconds = elapsed > 0 ? Math.min(longestStep, elapsed) : 0;
    this.lastTime = time;
    const shown = pose.body ? 'body' : 'hands';
    if (this.meshes.setVisibleParts(shown)) this.rig.forgetJoints();
    if (pose.body) this.applyBody(pose, pose.body, deltaSeconds);
    else this.applyHands(pose);
    this.attachments.update();
    for (const side of sides) {
      if (pose.fingers) this.setFingers(side, pose.fingers[side]);
      this.fingers[side].update(deltaSeconds);
    }
    this.animateDetails(pose.head, deltaSeconds);
  }

  /** Animates what no pose contains: eyes, lids, hair, and nodes that the file constrains to bones. */
  private animateDetails(head: AvatarPose['head'], deltaSeconds: number): void {
    const { vrm } = this;
    const { position, orientation } = head;
    this.face.update(head, deltaSeconds);
    vrm.nodeConstraintManager?.update();
    this.springs.update(this.object, position, orientation, deltaSeconds);
    for (const material of vrm.materials ?? []) (material as { update?(seconds: number): void }).update?.(deltaSeconds);
  }

  private applyBody({ head, feet }: AvatarPose, body: UpperBodyPose, deltaSeconds: number): void {
    const joints = forwardKinematics(this.skeleton, body, this.joints);
    this.idle.apply(joints, deltaSeconds);
    const { points } = this;
    points.hips = joints.hips;
    points.head = head;
    points.leftHand = joints.leftHand.position;
    points.rightHand = joints.rightHand.position;
    // The legs step under the estimated hips; the trunk may lower them to the rig's.
    this.legs.apply(points, deltaSeconds, feet);
    this.trunk.apply(joints);
    this.trunkShape.keepOut(joints);
    this.arms.untwist(joints);
    for (let i = 0; i < jointNames.length; i++) {
      const name = jointNames[i]!;
      const { position, orientation } = joints[name];
      this.rig.place(name, position, orientation);
    }
    this.arms.place(joints);
    this.rig.settle();
  }

  /** Draws head and hands alone where they were tracked. */
  private applyHands({ head, leftHand, rightHand }: AvatarPose): void {
    const headJoint = headJointOf(head, this.skeleton.eyesInHead, this.headJoint);
    const restHead = this.rig.rest('head');
    for (let i = 0; i < jointNames.length; i++) {
      const name = jointNames[i]!;
      const rest = this.rig.rest(name);
      if (!rest || !restHead) continue;
      // The skin of the head reaches down to the neck or, without one, the trunk: these keep their rest pose relative
      // to the head. A rig faces the other way.
      const from = setVec3(this.joint, restHead.x - rest.x, rest.y - restHead.y, restHead.z - rest.z);
      addScaled(headJoint, rotate(head.orientation, from, from), this.scale, from);
      this.rig.place(name, from, head.orientation, name === 'head');
    }
    this.arms.straighten();
    this.applyHand('left', leftHand);
    this.applyHand('right', rightHand);
    this.rig.settle();
  }

  private applyHand(side: Side, hand: AvatarPose['leftHand']): void {
    const name = side === 'left' ? 'leftHand' : 'rightHand';
    const lowerArm = side === 'left' ? 'leftLowerArm' : 'rightLowerArm';
    if (!hand) {
      this.rig.shrink(lowerArm);
      this.rig.shrink(name);
      return;
    }
    const orientation = handBoneRotation(side, hand.orientation, this.handBone);
    // The cuff of a sleeve is partly skinned to the forearm, which continues straight behind the hand.
    const elbow = rotate(orientation, this.skeleton.restOffsets[name], this.joint);
    subtract(hand.position, elbow, elbow);
    this.rig.place(lowerArm, elbow, orientation, false);
    this.rig.place(name, hand.position, orientation);
  }

  setFirstPerson(on: boolean): void {
    this.meshes.setFirstPerson(on);
  }

  setUpperBodyOnly(on: boolean): void {
    this.meshes.setUpperBodyOnly(on);
  }

  getBone(name: BoneName): Object3D | null {
    return this.vrm.humanoid.getRawBoneNode(name as VRMHumanBoneName);
  }

  attach(object: Object3D, joint: JointName): void {
    this.attachments.attach(object, joint);
  }

  setPalette(name: string | null): void {
    this.meshes.setPalette(name);
  }

  setSkinTone(tone: SkinTone | null): void {
    this.meshes.setSkinTone(tone);
  }

  setClothWeave(weave: ClothWeave | null): void {
    this.meshes.setClothWeave(weave);
  }

  simplifyAtDistance(simplifier: MeshSimplifier): Promise<void> {
    return betweenFrames(this.meshes.simplifyAtDistance(simplifier));
  }

  setOpacity(opacity: number): void {
    this.meshes.setOpacity(opacity);
  }

  setMouth(open: number): void {
    this.face.setMouth(open);
  }

  setGaze(target: Vec3 | null): void {
    this.face.setGaze(target);
  }

  setIdleMotion(on: boolean): void {
    this.idle.isOn = on;
  }

  setFingers(side: Side, shape: HandShape | null): void {
    this.fingers[side].set(shape);
  }

  handGeometry(side: Side): HandGeometry | null {
    return this.hands[side];
  }

  fingertips(side: Side): Readonly<Partial<Record<FingerName, Vec3>>> {
    return this.fingers[side].tips(this.object);
  }

  jointPositions(): Readonly<Partial<Record<AvatarJoint, Vec3>>> {
    return this.rig.joints;
  }

  dispose(): void {
    this.object.removeFromParent();
    VRMUtils.deepDispose(this.vrm.scene);
  }
}

export const createAvatar = (loaded: LoadedAvatar): Avatar => finishWork(makeAvatar(loaded));

/** Creates an avatar between frames, for a file that is opened while the page is in use. */
export const createAvatarBetweenFrames = (loaded: LoadedAvatar): Promise<Avatar> => betweenFrames(makeAvatar(loaded));
