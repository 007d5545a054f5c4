import {
  type VRM,
  type VRMExpressionPresetName,
  VRMLookAt,
  VRMLookAtBoneApplier,
  VRMLookAtExpressionApplier,
  VRMLookAtRangeMap,
} from '@pixiv/three-vrm';
import type { BufferGeometry, Mesh } from 'three';
import { damp } from '../core/math/damper';
import type { Pose } from '../core/math/pose';
import { conjugate, copyQuat, multiply, quat, rotate } from '../core/math/quat';
import { nextRandom, type RandomState } from '../core/math/random';
import { copyVec3, forward, subtract, type Vec3, vec3 } from '../core/math/vec3';
import { boneNode } from './humanoid/needed-bones';

/** The interval between two blinks, and the duration of a blink [s]. */
const shortestPause = 2;
const longestPause = 6;
const closing = 0.07;
const opening = 0.14;
/** The names of lid shapes in files without VRM's expressions (ARKit, Ready Player Me). */
const lidShapes = ['eyeBlinkLeft', 'eyeBlinkRight', 'eyesClosed', 'eyeBlink_L', 'eyeBlink_R'];
/** The names of mouth shapes, the one for "ah" first; a file with several of them is moved by the first. */
const mouthShapes = ['viseme_aa', 'aa', 'jawOpen', 'mouthOpen', 'MouthOpen', 'A', 'あ'];
/** The half-life [s] of the lips' motion: syllables are visible, flicker between two levels is not. */
const mouthHalfLife = 0.03;
/** The smallest difference at which a mouth is moved: a face at rest costs nothing. */
const mouthStill = 1 / 256;

/**
 * The angle [degrees] up to which eyes hold their target while the head turns; beyond it they jump to where it faces.
 */
const widestGaze = 11;
/** The angle [degrees] up to which eyes are turned to a target that is set, and the half-life of that turn [s]. */
const widestTarget = 38;
const gazeHalfLife = 0.025;
/** The share of the expression "surprised" with an open mouth: brows go with speech; and the half-life of that [s]. */
const browShare = 0.3;
const browHalfLife = 0.12;
/** The largest turn of the eyes of a file without VRM [degrees]. */
const eyeRange = new VRMLookAtRangeMap(30, 30);

interface Shape {
  readonly influences: number[];
  readonly index: number;
}

/** Returns the shapes that `chosen` selects in each of a body's meshes. */
function shapesOf(vrm: VRM, chosen: (has: (name: string) => boolean) => readonly string[]): readonly Shape[] {
  const shapes: Shape[] = [];
  vrm.scene.traverse((node) => {
    const { morphTargetDictionary, morphTargetInfluences } = node as Mesh;
    if (!morphTargetDictionary || !morphTargetInfluences) return;
    for (const name of chosen((name) => morphTargetDictionary[name] !== undefined)) {
      shapes.push({ influences: morphTargetInfluences, index: morphTargetDictionary[name] as number });
    }
  });
  return shapes;
}

/** Returns the lid shapes of a file that is no VRM. */
const lidsOf = (vrm: VRM): readonly Shape[] =>
  shapesOf(vrm, (has) => {
    const named = lidShapes.filter(has);
    // With shapes for each eye, the shape for both is left out.
    const separate = named.filter((name) => name !== 'eyesClosed');
    return separate.length > 0 ? separate : named;
  });

/** Returns the mouth shapes of a file that is no VRM: the first that each mesh has. */
const mouthOf = (vrm: VRM): readonly Shape[] => shapesOf(vrm, (has) => mouthShapes.filter(has).slice(0, 1));

/** Moves a part of a face by a weight from 0 to 1: VRM's expression, or the shapes of a file without it. */
class Mover {
  readonly #vrm: VRM;
  readonly #expression: VRMExpressionPresetName;
  readonly #shapes: readonly Shape[];
  readonly isPresent: boolean;

  constructor(vrm: VRM, expression: VRMExpressionPresetName, shapes: (vrm: VRM) => readonly Shape[]) {
    this.#vrm = vrm;
    this.#expression = expression;
    const expressive = vrm.expressionManager?.getExpression(expression) != null;
    this.#shapes = expressive ? [] : shapes(vrm);
    this.isPresent = expressive || this.#shapes.length > 0;
  }

  move(weight: number): void {
    for (let i = 0; i < this.#shapes.length; i++) {
      const { influences, index } = this.#shapes[i]!;
      influences[index] = weight;
    }
    const expressions = this.#vrm.expressionManager;
    if (this.#shapes.length > 0 || !expressions) return;
    expressions.setValue(this.#expression, weight);
    expressions.update();
  }
}

/**
 * Removes the morph attributes of meshes while the mouth is shut. They cost a shader program of their own, which
 * receives all lights in every frame, and a texture for each body. They are present until the first frame, so that both
 * programs are compiled beforehand. Meshes with lid shapes keep theirs, because lids blink often.
 */
class MouthMeshes {
  readonly #geometries: { readonly geometry: BufferGeometry; readonly shapes: BufferGeometry['morphAttributes'] }[] =
    [];
  readonly #without: BufferGeometry['morphAttributes'] = {};
  #shaped = true;

  constructor(vrm: VRM) {
    vrm.scene.traverse((node) => {
      const { geometry, morphTargetDictionary } = node as Mesh;
      const names = Object.keys(morphTargetDictionary ?? {});
      if (names.length !== 1 || !mouthShapes.includes(names[0]!)) return;
      this.#geometries.push({ geometry, shapes: geometry.morphAttributes });
    });
  }

  setShaped(shaped: boolean): void {
    if (shaped === this.#shaped) return;
    this.#shaped = shaped;
    for (const { geometry, shapes } of this.#geometries) geometry.morphAttributes = shaped ? shapes : this.#without;
  }
}

/**
 * Returns whether an expression can be mixed with others by a small share: it has steps in between, and stops neither
 * lids, mouth nor eyes.
 */
function isMixable(vrm: VRM, name: VRMExpressionPresetName): boolean {
  const expression = vrm.expressionManager?.getExpression(name);
  if (!expression || expression.isBinary) return false;
  const { overrideBlink, overrideLookAt, overrideMouth } = expression;
  return [overrideBlink, overrideLookAt, overrideMouth].every((override) => override === 'none');
}

/** Returns the look-at of a rig with eye bones; null: it has none. */
function gazeOf(vrm: VRM): VRMLookAt | null {
  if (vrm.lookAt) return vrm.lookAt;
  if (!boneNode(vrm, 'leftEye') || !boneNode(vrm, 'rightEye')) return null;
  const applier = new VRMLookAtBoneApplier(vrm.humanoid, eyeRange, eyeRange, eyeRange, eyeRange);
  return new VRMLookAt(vrm.humanoid, applier);
}

const inverse = quat(0, 0, 0, 1);
const ahead = vec3(0, 0, 0);
const degrees = 180 / Math.PI;

/** The angles of a direction in the frame of a head [degrees]: to the left, and down. */
const yawOf = ({ x, z }: Vec3): number => Math.atan2(-x, -z) * degrees;
const pitchOf = ({ x, y, z }: Vec3): number => Math.atan2(-y, Math.hypot(x, z)) * degrees;

const isWithin = (widest: number, direction: Vec3): boolean =>
  Math.hypot(yawOf(direction), pitchOf(direction)) <= widest;

/** Animates the face of an avatar: blinking, the direction of the eyes, the mouth, and brows that go with it. */
export class Face {
  readonly #lids: Mover;
  readonly #mouth: Mover;
  /** null: the file has no expression for it, or one that excludes others. */
  readonly #brows: Mover | null;
  readonly #mouthMeshes: MouthMeshes;
  readonly #gaze: VRMLookAt | null;
  /** The head's rotation when the eyes reached their target. */
  readonly #held = quat(0, 0, 0, 1);
  readonly #target = vec3(0, 0, 0);
  #hasTarget = false;
  #random: RandomState;
  /** The time until the next blink [s]; below 0: since one began. */
  #until = shortestPause;
  #closed = 0;
  /** The opening of the mouth, and its target. */
  #open = 0;
  #opening = 0;
  #raised = 0;

  /** `seed`: faces with different seeds blink at different times. */
  constructor(vrm: VRM, seed: number) {
    this.#random = { seed };
    this.#gaze = gazeOf(vrm);
    this.#lids = new Mover(vrm, 'blink', lidsOf);
    this.#mouth = new Mover(vrm, 'aa', mouthOf);
    this.#brows = isMixable(vrm, 'surprised') ? new Mover(vrm, 'surprised', () => []) : null;
    this.#mouthMeshes = new MouthMeshes(vrm);
  }

  /** Sets the place that the eyes turn to while it is before the face, floor frame [m]; null: none. */
  setGaze(target: Vec3 | null): void {
    this.#hasTarget = target !== null;
    if (target) copyVec3(target, this.#target);
  }

  /** Sets the target of the mouth's opening: 0 shut to 1; NaN: shut. */
  setMouth(open: number): void {
    this.#opening = open > 0 ? Math.min(open, 1) : 0;
  }

  /** Advances by one frame. The head's pose is in the floor frame, at the eyes, and faces −Z at identity. */
  update(head: Pose<'floor'>, deltaSeconds: number): void {
    if (this.#lids.isPresent) this.#blink(deltaSeconds);
    if (this.#mouth.isPresent) this.#speak(deltaSeconds);
    if (this.#brows) this.#raise(this.#brows, deltaSeconds);
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
    this.#lids.move(closed);
  }

  #speak(deltaSeconds: number): void {
    if (this.#open !== this.#opening) {
      const open = damp(this.#open, this.#opening, mouthHalfLife, deltaSeconds);
      this.#open = Math.abs(this.#opening - open) < mouthStill ? this.#opening : open;
      this.#mouth.move(this.#open);
    }
    this.#mouthMeshes.setShaped(this.#open > 0);
  }

  #raise(brows: Mover, deltaSeconds: number): void {
    const target = browShare * this.#open;
    if (this.#raised === target) return;
    const raised = damp(this.#raised, target, browHalfLife, deltaSeconds);
    this.#raised = Math.abs(target - raised) < mouthStill ? target : raised;
    brows.move(this.#raised);
  }

  #look(gaze: VRMLookAt, { position, orientation }: Pose<'floor'>, deltaSeconds: number): void {
    conjugate(orientation, inverse);
    if (this.#hasTarget) rotate(inverse, subtract(this.#target, position, ahead), ahead);
    if (this.#hasTarget && isWithin(widestTarget, ahead)) {
      copyQuat(orientation, this.#held);
      gaze.yaw = damp(gaze.yaw, yawOf(ahead), gazeHalfLife, deltaSeconds);
      gaze.pitch = damp(gaze.pitch, pitchOf(ahead), gazeHalfLife, deltaSeconds);
    } else {
      // The direction in which the eyes looked, in the frame of the head: opposite to its rotation, never ahead of it.
      rotate(multiply(inverse, this.#held, inverse), forward, ahead);
      const holds = isWithin(widestGaze, ahead);
      if (!holds) copyQuat(orientation, this.#held);
      gaze.yaw = holds ? yawOf(ahead) : 0;
      gaze.pitch = holds ? pitchOf(ahead) : 0;
    }
    gaze.update(deltaSeconds);
    if (gaze.applier instanceof VRMLookAtExpressionApplier) gaze.applier.expressions.update();
  }
}
