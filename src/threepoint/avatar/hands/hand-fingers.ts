import type { VRM } from '@pixiv/three-vrm';
import type { Object3D } from 'three';
import { closePinch } from '../../core/body/close-pinch';
import { FingerMemory } from '../../core/body/finger-memory';
import { fingerFrames, type HandGeometry, makeFingerFrames } from '../../core/body/hand-geometry';
import { copyHandShape, type FingerName, type HandShape, makeHandShape } from '../../core/body/hand-shape';
import { conjugate, multiply, quat } from '../../core/math/quat';
import type { Side } from '../../core/math/side';
import type { Vec3 } from '../../core/math/vec3';
import { ofSide, type RigFinger, type RigHand, readRigHand } from './rig-hand';

const frames = makeFingerFrames();
/** The rotations of a finger's bones since the rest pose. */
const turned = makeFingerFrames();
const against = quat(0, 0, 0, 1);
const carried = quat(0, 0, 0, 1);

/** Draws one hand's fingers on a rig; they are relaxed at first. */
export class HandFingers {
  readonly #side: Side;
  readonly #rig: RigHand;
  readonly #memory = new FingerMemory();
  readonly #seen = makeHandShape();
  #isSeen = false;
  /** The drawn shape, in which a pinch is adapted to the rig's proportions. */
  readonly #shown = makeHandShape();
  /** The shape that the bones were bent to last. */
  readonly #bent = makeHandShape();
  #begun = false;

  constructor(vrm: VRM, side: Side) {
    this.#side = side;
    this.#rig = readRigHand(vrm, side);
    // Fingers rarely move: thirty matrices need not be composed in every frame. Constraints of a file write rotations
    // only.
    const constrained = (vrm.nodeConstraintManager?.constraints.size ?? 0) > 0;
    for (const { bones } of this.#rig.fingers) for (const { node } of bones) node.matrixAutoUpdate = constrained;
    this.update(0);
  }

  /** The geometry of the rig's hand in its own metres; null: the rig lacks a finger bone. */
  get geometry(): HandGeometry | null {
    return this.#rig.geometry;
  }

  /**
   * Returns the drawn fingertips of the rig in the frame of an object that carries it [m], in new objects for tools and
   * tests.
   */
  tips(frame: Object3D): Partial<Record<FingerName, Vec3>> {
    const found: Partial<Record<FingerName, Vec3>> = {};
    for (const { name, bones, tip } of this.#rig.fingers) {
      const at = tip.clone();
      // Updates node by node: world matrices may be a frame old, and bones are not notified when the rig's parent has
      // moved.
      for (let node: Object3D | null = bones.at(-1)?.node ?? null; node && node !== frame; node = node.parent) {
        if (node.matrixAutoUpdate) node.updateMatrix();
        at.applyMatrix4(node.matrix);
      }
      if (bones.length > 0) found[name] = at;
    }
    return found;
  }

  /** Sets the tracked shape from now on; null: none. The shape is copied. */
  set(shape: HandShape | null): void {
    this.#isSeen = shape !== null;
    if (shape) copyHandShape(shape, this.#seen);
  }

  /** Bends the bones. `deltaSeconds`: the time since the last call. */
  update(deltaSeconds: number): void {
    copyHandShape(this.#memory.follow(this.#isSeen ? this.#seen : null, deltaSeconds), this.#shown);
    if (this.#rig.geometry) closePinch(this.#shown, this.#rig.geometry);
    for (const finger of this.#rig.fingers) if (this.#changed(finger)) this.#bend(finger);
    copyHandShape(this.#shown, this.#bent);
    this.#begun = true;
  }

  #changed({ name }: RigFinger): boolean {
    const a = this.#shown[name];
    const b = this.#bent[name];
    return !this.#begun || a.knuckle !== b.knuckle || a.spread !== b.spread || a.middle !== b.middle || a.end !== b.end;
  }

  #bend({ name, bones, fromRest }: RigFinger): void {
    fingerFrames(name, this.#shown[name], frames);
    for (let i = 0; i < 3; i++) multiply(frames[i as 0], fromRest[i as 0], turned[i as 0]);
    for (const { node, index, carrier, before, after } of bones) {
      if (carrier === null) ofSide(this.#side, turned[index], against);
      else ofSide(this.#side, multiply(conjugate(turned[carrier], carried), turned[index], carried), against);
      multiply(before, multiply(against, after, against), against);
      node.quaternion.copy(against);
      node.updateMatrix();
    }
  }
}
