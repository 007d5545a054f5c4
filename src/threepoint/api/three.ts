// "threepoint/three": the body on an avatar of three.js, driven by a WebXR session.
import { EventDispatcher, Group, type Object3D, type WebGLRenderer } from 'three';
import { type Avatar, createAvatar } from '../avatar/avatar';
import type { BoneMap } from '../avatar/humanoid/bone-names';
import { parseAvatar } from '../avatar/load-avatar';
import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import { reasonOf } from '../core/errors/reasons';
import type { EstimatorName } from '../core/estimation/pose-estimator';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { DeviceBodyReader } from '../xr/device-body-reader';
import { TrackedSession } from '../xr/tracked-session';
import { Body, type BodyOptions } from './body';
import type { CalibrationSource, TrackedPoint } from './body-solver';
import { loadLearned } from './load-learned';
import type { MotionWriter } from './motion-export';

export type { Avatar } from '../avatar/avatar';
export type { BoneMap } from '../avatar/humanoid/bone-names';

export interface LoadAvatarOptions {
  /** For a humanoid without VRM: the name of the file's node for each bone, in VRM's names. At rest it stands in a T-pose and faces +Z. */
  readonly bones?: BoneMap;
}

/** An address, a file, or the bytes of one. */
export type AvatarSource = string | URL | Blob | ArrayBuffer | ArrayBufferView;

/**
 * An avatar from an address, a file or its bytes: VRM 0.x or 1.0, or a humanoid GLB with a map of its bones. Rejects with a sentence that names
 * the file: not reached, no GLB, larger than `avatarLimits`, a bone missing.
 */
export async function loadAvatar(source: AvatarSource, { bones }: LoadAvatarOptions = {}): Promise<Avatar> {
  const { name, bytes } = await read(source);
  return createAvatar(await parseAvatar(bytes, name, { bones }));
}

/**
 * Makes GLB files of an avatar that moves, as `to` of `exportMotion`: all that is in its file stays, bones turn as the person's, and steps are as
 * long as its own legs make them. Rejects as `loadAvatar`.
 */
export async function avatarMotion(source: AvatarSource, { bones }: LoadAvatarOptions = {}): Promise<MotionWriter> {
  const [{ avatarClip }, { name, bytes }] = await Promise.all([import('../avatar/avatar-clip'), read(source)]);
  return avatarClip(bytes, name, { bones });
}

async function read(source: AvatarSource): Promise<{ name: string; bytes: ArrayBuffer }> {
  if (source instanceof ArrayBuffer) return { name: 'the avatar', bytes: source };
  if (ArrayBuffer.isView(source)) {
    const { buffer, byteOffset, byteLength } = source;
    return { name: 'the avatar', bytes: new Uint8Array(buffer, byteOffset, byteLength).slice().buffer };
  }
  if (source instanceof Blob) {
    return { name: source instanceof File ? source.name : 'the avatar', bytes: await source.arrayBuffer() };
  }
  const address = String(source);
  const name = address.split(/[?#]/)[0]?.split('/').at(-1) || address;
  const response = await fetch(address).catch((error: unknown) => {
    throw new Error(`${name}: could not be fetched (${reasonOf(error)})`);
  });
  if (!response.ok) throw new Error(`${name}: the server answers ${response.status} ${response.statusText}`.trim());
  return { name, bytes: await response.arrayBuffer() };
}

export interface BodyTrackerOptions extends Omit<BodyOptions, 'events'> {
  /** From `loadAvatar`; put `tracker.object` into the scene, or into what moves its cameras. */
  readonly avatar: Avatar;
  /**
   * Whether frames get the body that the device itself tracks (WebXR Body Tracking), which the estimator 'device' draws. Default: false. The page
   * asks for it: its session has the feature 'body-tracking'.
   */
  readonly deviceBody?: boolean;
  /** Where another contract of the learned network lies (.json), its weights beside it. */
  readonly modelUrl?: string | URL;
}

export interface BodyTrackerEvents {
  readonly calibrated: { readonly calibration: Calibration; readonly source: CalibrationSource };
  readonly heightmismatch: { readonly difference: number };
  readonly fallback: { readonly estimator: EstimatorName; readonly reason: string };
  readonly changed: object;
  readonly discontinuity: object;
  readonly trackinglost: { readonly point: TrackedPoint };
  readonly trackingfound: { readonly point: TrackedPoint };
}

/**
 * The wearer's own body in a page of three.js: reads head and hands of the renderer's session, estimates the body, bends the avatar.
 * Call `update` in each animation frame before drawing.
 */
export class BodyTracker extends EventDispatcher<BodyTrackerEvents> {
  readonly avatar: Avatar;
  /** What is estimated, without session and avatar: what was wanted, what cannot be had, where the network runs. */
  readonly body: Body;
  readonly #renderer: WebGLRenderer;
  readonly #deviceBody: boolean;
  readonly #object = new Group();
  /** The renderer's session and its tracking; null: there is none. */
  #session: XRSession | null = null;
  #tracked: TrackedSession | null = null;
  /** Whether the wearer's eyes are in the head that is drawn. */
  #firstPerson = false;
  #disposed = false;

  /** Throws a RangeError where the calibration is no person's. */
  constructor(renderer: WebGLRenderer, { avatar, modelUrl, deviceBody = false, ...options }: BodyTrackerOptions) {
    super();
    this.avatar = avatar;
    this.#deviceBody = deviceBody;
    this.#renderer = renderer;
    const networks =
      modelUrl === undefined
        ? {}
        : { networks: (name: string) => (name === 'learned' ? loadLearned({ modelUrl }) : Promise.reject(noWeights)) };
    this.body = new Body({
      ...networks,
      ...options,
      events: {
        calibrated: (calibration, source) => {
          avatar.setCalibration(calibration);
          this.dispatchEvent({ type: 'calibrated', calibration, source });
        },
        heightmismatch: (difference) => this.dispatchEvent({ type: 'heightmismatch', difference }),
        changed: () => this.dispatchEvent({ type: 'changed' }),
        discontinuity: () => this.dispatchEvent({ type: 'discontinuity' }),
        fallback: (estimator, reason) => this.dispatchEvent({ type: 'fallback', estimator, reason }),
        trackinglost: (point) => this.dispatchEvent({ type: 'trackinglost', point }),
        trackingfound: (point) => this.dispatchEvent({ type: 'trackingfound', point }),
      },
    });
    avatar.setCalibration(this.body.calibration);
    this.#object.name = 'body';
    this.#object.add(avatar.object);
    this.#object.visible = false;
  }

  /**
   * To be put into the scene, with its origin where the renderer's reference space has its own; shown while there is a pose. In it `avatar.object`
   * lies where the floor is, wherever the page has moved its wearer.
   */
  get object(): Object3D {
    return this.#object;
  }

  /**
   * Of the newest frame, floor frame [m]: the floor's space that the renderer asked the session for, or where `recentre` laid it. Overwritten by the
   * next; null before the first tracked frame.
   */
  get pose(): AvatarPose | null {
    return this.body.pose;
  }

  get calibration(): Calibration {
    return this.body.calibration;
  }

  /** What draws now: 'ik' while a network loads, and where it fails. */
  get estimator(): EstimatorName {
    return this.body.estimator;
  }

  /** Resolves when this estimator draws, or when the event `fallback` told why it cannot. */
  setEstimator(estimator: EstimatorName): Promise<void> {
    return this.body.setEstimator(estimator);
  }

  /** The wearer's measures [m], or 'auto'. Throws a RangeError where they are no person's. */
  calibrate(calibration: Calibration | 'auto'): void {
    this.body.calibrate(calibration);
  }

  /**
   * One animation frame: timeMs and frame as `setAnimationLoop` gives them. Without a session nothing moves and the avatar is hidden. Call it
   * before any await of the frame. Throws an InvalidStateError where the frame is over.
   */
  update(timeMs: number, frame: XRFrame | null | undefined): void {
    if (this.#disposed) return;
    const time = this.body.tick(timeMs);
    this.#attend();
    const session = this.#tracked;
    // The renderer may still have the space of the session before: the first frame starts the tracking.
    if (!session || !frame || !session.start()) return;
    const tracked = session.read(frame, time);
    const { position, orientation } = session.floorPose;
    this.avatar.object.position.copy(position);
    this.avatar.object.quaternion.copy(orientation);
    this.#apply(tracked, null);
  }

  /**
   * The same from head and wrists that the page has itself, floor frame [m, s]: of another device of the wearer's, or of a stand-in with these
   * measures (an actor, a recording).
   */
  updateFrom(frame: TrackingFrame | null, standIn: Calibration | null = null): void {
    if (this.#disposed) return;
    this.#attend();
    this.#apply(frame, standIn);
  }

  /** The wearer stands at the floor's origin from now on and looks along −Z; the renderer's reference space moves along. */
  recentre(): void {
    if (this.#disposed) return;
    if (this.#tracked) this.#tracked.recentre();
    else this.body.discontinuity();
  }

  /** Ends what it listens to and takes the avatar apart; no frame changes anything from then on. Resolves when every network is let go that was loaded for it. */
  dispose(): Promise<void> {
    this.#disposed = true;
    this.#leave();
    this.#object.removeFromParent();
    this.avatar.dispose();
    return this.body.dispose();
  }

  #apply(tracked: TrackingFrame | null, standIn: Calibration | null): void {
    const pose = this.body.update(tracked, standIn);
    this.#setFirstPerson(this.#session !== null && standIn === null);
    if (!tracked || !pose) return;
    this.avatar.setFingers('left', tracked.fingers?.left ?? null);
    this.avatar.setFingers('right', tracked.fingers?.right ?? null);
    this.avatar.setPose(pose, tracked.time);
    this.#object.visible = true;
  }

  /** Follows the renderer's session; the tracking of the one before is over. */
  #attend(): void {
    const session = this.#renderer.xr.getSession();
    if (session === this.#session) return;
    this.#leave();
    this.#session = session;
    this.#tracked =
      session &&
      new TrackedSession({
        session,
        drawing: this.#renderer.xr,
        bodyReader: this.#deviceBody ? new DeviceBodyReader() : null,
        onStart: () => this.body.startSession(),
        onDiscontinuity: () => this.body.discontinuity(),
        onEnd: () => this.#leave(),
      });
  }

  #leave(): void {
    if (!this.#session) return;
    this.#tracked?.dispose();
    this.#tracked = null;
    this.#session = null;
    this.body.endSession();
    this.#setFirstPerson(false);
    this.avatar.object.position.set(0, 0, 0);
    this.avatar.object.quaternion.identity();
    this.#object.visible = false;
  }

  /** Told where it changes: a page may have its own way. */
  #setFirstPerson(on: boolean): void {
    if (on === this.#firstPerson) return;
    this.#firstPerson = on;
    this.avatar.setFirstPerson(on);
  }
}

const noWeights = new Error('modelUrl: the learned network alone runs without a runtime');
