import type { VRM, VRMHumanBoneName } from '@pixiv/three-vrm';
import { type Object3D, Quaternion, Vector3 } from 'three';
import type { Side } from '../core/math/side';

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

/** Fingers of a hand at ease [share of the way to a fist]. */
const relaxedCurl = 0.22;

/** The fingers of both hands, relaxed at first. */
export class Fingers {
  private readonly bones: readonly FingerBone[];
  private readonly grip: Record<Side, number> = { left: relaxedCurl, right: relaxedCurl };

  constructor(vrm: VRM) {
    this.bones = readFingers(vrm);
    this.bend('left');
    this.bend('right');
  }

  /** How far a hand is closed, 0 to 1 a fist; at ease it is closed a little. */
  close(side: Side, closed: number): void {
    const grip = Math.max(relaxedCurl, Math.min(1, closed));
    if (grip === this.grip[side]) return;
    this.grip[side] = grip;
    this.bend(side);
  }

  private bend(bent: Side): void {
    for (const { node, rest, axis, side, share } of this.bones) {
      if (side === bent) node.quaternion.copy(rest).multiply(turn.setFromAxisAngle(axis, share * this.grip[side]));
    }
  }
}

const turn = new Quaternion();
