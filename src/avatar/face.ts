import { type VRM, VRMLookAt, VRMLookAtBoneApplier, VRMLookAtRangeMap } from '@pixiv/three-vrm';
import type { Mesh } from 'three';
import { clamp } from '../core/math/damper';
import { conjugate, copyQuat, multiply, type Quat, quat, rotate } from '../core/math/quat';
import { nextRandom, type RandomState } from '../core/math/random';
import { forward, vec3 } from '../core/math/vec3';
import { boneNode } from './humanoid';

/** People blink every two to six seconds, and each blink takes a fifth of one. */
const shortestPause = 2;
const longestPause = 6;
const closing = 0.07;
const opening = 0.14;
/** A file without VRM's expressions may have these shapes of a face (ARKit's, Ready Player Me's). */
const lidShapes = ['eyeBlinkLeft', 'eyeBlinkRight', 'eyesClosed', 'eyeBlink_L', 'eyeBlink_R'];

/** Eyes hold what they look at while the head turns, and leap to what it faces now when that is further off than this [degrees]. */
const widestGaze = 11;
/** Eyes of a file without VRM turn as far as they are asked to [degrees]. */
const eyeRange = new VRMLookAtRangeMap(30, 30);

/** Lids of a file without VRM: where its meshes keep how far they are closed. */
function lidsOf(vrm: VRM): { readonly influences: number[]; readonly index: number }[] {
  const lids: { influences: number[]; index: number }[] = [];
  vrm.scene.traverse((node) => {
    const { morphTargetDictionary, morphTargetInfluences } = node as Mesh;
    if (!morphTargetDictionary || !morphTargetInfluences) return;
    const named = lidShapes.filter((name) => morphTargetDictionary[name] !== undefined);
    // A shape for both eyes closes them twice beside one for each.
    const separate = named.filter((name) => name !== 'eyesClosed');
    for (const name of separate.length > 0 ? separate : named) {
      lids.push({ influences: morphTargetInfluences, index: morphTargetDictionary[name] as number });
    }
  });
  return lids;
}

/** Eyes of a body whose rig has bones for them. */
function gazeOf(vrm: VRM): VRMLookAt | null {
  if (vrm.lookAt) return vrm.lookAt;
  if (!boneNode(vrm, 'leftEye') || !boneNode(vrm, 'rightEye')) return null;
  const applier = new VRMLookAtBoneApplier(vrm.humanoid, eyeRange, eyeRange, eyeRange, eyeRange);
  return new VRMLookAt(vrm.humanoid, applier);
}

const inverse = quat(0, 0, 0, 1);
const ahead = vec3(0, 0, 0);

/** The face of a body: lids that blink, eyes that look where the head faces. */
export class Face {
  readonly #vrm: VRM;
  readonly #lids: ReturnType<typeof lidsOf>;
  readonly #gaze: VRMLookAt | null;
  readonly #blinks: boolean;
  /** How the head was turned when the eyes came to rest on what they look at. */
  readonly #held = quat(0, 0, 0, 1);
  #random: RandomState;
  /** Until the next blink, below 0: since one began [s]. */
  #until = shortestPause;
  #closed = 0;

  /** `seed`: faces of different seeds blink at different times. */
  constructor(vrm: VRM, seed: number) {
    this.#vrm = vrm;
    this.#random = { seed };
    this.#gaze = gazeOf(vrm);
    const expressive = vrm.expressionManager?.getExpression('blink') != null;
    this.#lids = expressive ? [] : lidsOf(vrm);
    this.#blinks = expressive || this.#lids.length > 0;
  }

  /** One frame; the head's orientation in the floor frame, which at identity faces −Z. */
  update(head: Quat, deltaSeconds: number): void {
    if (this.#blinks) this.#blink(deltaSeconds);
    if (this.#gaze) this.#look(this.#gaze, head, deltaSeconds);
  }

  #blink(deltaSeconds: number): void {
    this.#until -= deltaSeconds;
    const since = -this.#until;
    if (since > closing + opening) {
      const { value, state } = nextRandom(this.#random);
      this.#random = state;
      this.#until = shortestPause + value * (longestPause - shortestPause);
    }
    const closed = since <= 0 ? 0 : since < closing ? since / closing : Math.max(0, 1 - (since - closing) / opening);
    if (closed === this.#closed) return;
    this.#closed = closed;
    for (const { influences, index } of this.#lids) influences[index] = closed;
    const expressions = this.#vrm.expressionManager;
    if (this.#lids.length > 0 || !expressions) return;
    expressions.setValue('blink', closed);
    expressions.update();
  }

  #look(gaze: VRMLookAt, head: Quat, deltaSeconds: number): void {
    // What was looked at, seen from the head as it is turned now: on the way back from its turn, never ahead of it.
    rotate(multiply(conjugate(head, inverse), this.#held, inverse), forward, ahead);
    const yaw = (Math.atan2(-ahead.x, -ahead.z) * 180) / Math.PI;
    const pitch = (Math.asin(clamp(-ahead.y, -1, 1)) * 180) / Math.PI;
    const leaps = Math.hypot(yaw, pitch) > widestGaze;
    if (leaps) copyQuat(head, this.#held);
    gaze.yaw = leaps ? 0 : yaw;
    gaze.pitch = leaps ? 0 : pitch;
    gaze.update(deltaSeconds);
  }
}
