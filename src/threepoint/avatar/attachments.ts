import { Group, type Object3D } from 'three';
import type { JointName } from '../core/body/joints';
import { wristFromHandBone } from '../core/body/skeleton';
import { conjugate, multiply, type Quat, quat } from '../core/math/quat';
import type { Rig } from './rig/rig';

/** The rotations from a hand bone's axes to those of its wrist. */
const wristAxes: Partial<Record<JointName, Quat>> = {
  leftHand: conjugate(wristFromHandBone.left),
  rightHand: conjugate(wristFromHandBone.right),
};
const turned = quat(0, 0, 0, 1);

/** Carries objects along with the joints of a drawn body, unscaled. */
export class Attachments {
  readonly #avatar: Group;
  readonly #rig: Rig;
  /** The parents of the attached objects, floor frame. */
  readonly #holders = new Map<JointName, Group>();

  constructor(avatar: Group, rig: Rig) {
    this.#avatar = avatar;
    this.#rig = rig;
  }

  attach(object: Object3D, joint: JointName): void {
    const holder = this.#holders.get(joint) ?? new Group();
    holder.name = `at ${joint}`;
    holder.add(object);
    this.#avatar.add(holder);
    this.#holders.set(joint, holder);
    this.update();
  }

  /** Moves the objects to the joints as they are drawn; those of a hidden joint are hidden. */
  update(): void {
    for (const [joint, holder] of this.#holders) {
      const at = this.#rig.joints[joint];
      const bone = this.#rig.bones.get(joint);
      holder.visible = at !== undefined;
      if (!at || !bone) continue;
      const axes = wristAxes[joint];
      holder.position.copy(at);
      holder.quaternion.copy(axes ? multiply(bone.turn, axes, turned) : bone.turn);
    }
  }
}
