import type { VRM } from '@pixiv/three-vrm';
import { closePinch } from '../core/body/close-pinch';
import { FingerMemory } from '../core/body/finger-memory';
import { fingerFrames, makeFingerFrames } from '../core/body/hand-geometry';
import { copyHandShape, type HandShape, makeHandShape } from '../core/body/hand-shape';
import { conjugate, multiply, quat } from '../core/math/quat';
import type { Side } from '../core/math/side';
import { ofSide, type RigFinger, type RigHand, readHand } from './finger-bones';

const sides = ['left', 'right'] as const;

const frames = makeFingerFrames();
/** How each bone of a finger has turned since the rest pose. */
const turned = makeFingerFrames();
const against = quat(0, 0, 0, 1);
const carried = quat(0, 0, 0, 1);

/** One hand's fingers on a rig. */
class HandFingers {
  readonly #side: Side;
  readonly #rig: RigHand;
  readonly #memory = new FingerMemory();
  readonly #seen = makeHandShape();
  #isSeen = false;
  /** What is drawn: on a rig of other proportions a pinch takes other angles. */
  readonly #shown = makeHandShape();
  /** What the bones were bent to last. */
  readonly #bent = makeHandShape();
  #begun = false;

  constructor(vrm: VRM, side: Side) {
    this.#side = side;
    this.#rig = readHand(vrm, side);
  }

  set(shape: HandShape | null): void {
    this.#isSeen = shape !== null;
    if (shape) copyHandShape(shape, this.#seen);
  }

  update(deltaSeconds: number): void {
    copyHandShape(this.#memory.follow(this.#isSeen ? this.#seen : null, deltaSeconds), this.#shown);
    if (this.#rig.geometry) closePinch(this.#shown, this.#rig.geometry);
    for (const finger of this.#rig.fingers) if (this.#changed(finger)) this.#bend(finger);
    copyHandShape(this.#shown, this.#bent);
    this.#begun = true;
  }

  #changed({ name }: RigFinger): boolean {
    const [a, b] = [this.#shown[name], this.#bent[name]];
    return !this.#begun || a.knuckle !== b.knuckle || a.spread !== b.spread || a.middle !== b.middle || a.end !== b.end;
  }

  #bend({ name, bones, fromRest }: RigFinger): void {
    fingerFrames(name, this.#shown[name], frames);
    for (let i = 0; i < 3; i++) multiply(frames[i as 0], fromRest[i as 0], turned[i as 0]);
    for (const { node, index, carrier, before, after } of bones) {
      if (carrier === null) ofSide(this.#side, turned[index], against);
      else ofSide(this.#side, multiply(conjugate(turned[carrier], carried), turned[index], carried), against);
      multiply(before, multiply(against, after, against), against);
      node.quaternion.set(against.x, against.y, against.z, against.w);
    }
  }
}

/** The fingers of both hands, at ease at first. */
export class Fingers {
  readonly #hands: Readonly<Record<Side, HandFingers>>;

  constructor(vrm: VRM) {
    this.#hands = { left: new HandFingers(vrm, 'left'), right: new HandFingers(vrm, 'right') };
    this.update(0);
  }

  /** What is seen of a hand from now on; null: nothing. Copied. */
  set(side: Side, shape: HandShape | null): void {
    this.#hands[side].set(shape);
  }

  /** Bends the bones, so long after the last time [s]. */
  update(deltaSeconds: number): void {
    for (const side of sides) this.#hands[side].update(deltaSeconds);
  }
}
