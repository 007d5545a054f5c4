// "threepoint/three": draws the body as an avatar in three.js, driven by a WebXR session.

import { EventDispatcher, type EventListener, Group, type Object3D, type WebGLRenderer } from 'three';
import { type Avatar, createAvatar } from '../avatar/avatar';
import { createWorkerCheck } from '../avatar/file/avatar-check-client';
import { parseAvatar } from '../avatar/load-avatar';
import { loadUntrustedAvatar } from '../avatar/load-untrusted-avatar';
import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import { reasonOf } from '../core/errors/reasons';
import type { EstimatorName } from '../core/estimation/pose-estimator';
import type { TrackerMismatch } from '../core/estimation/tracker-watch';
import { nameOfAddress } from '../core/files';
import type { BoneMap } from '../core/humanoid/bones';
import { assertPinning, type BodyTrackers, type TrackingFrame } from '../core/tracking/tracking-frame';
import { DeviceBodyReader } from '../xr/device-body-reader';
import { TrackedSession } from '../xr/tracked-session';
import { assertOptions } from './assert-options';
import { Body, type BodyOptions } from './body';
import { type CalibrationSource, bodyOptions as solverOptions, type TrackedPoint } from './body-solver';
import { readBundledMannequin } from './bundled-mannequin';
import { startValidator } from './bundled-validator';
import { loadLearned } from './load-learned';
import type { MotionWriter } from './motion-file';
import { warnAfterDispose, warnOfFallback } from './warnings';

export type { Avatar } from '../avatar/avatar';
export type { BoneMap } from '../core/humanoid/bones';

export interface LoadAvatarOptions {
  /**
   * The name of the file's node for each bone (by VRM's bone names), instead of the bones that a VRM states or that are
   * matched in another humanoid. For a VRM the map must contain the legs.
   */
  readonly bones?: BoneMap;
  /**
   * Whether the file comes from another person. It is validated in a worker before it is decoded, and has lower limits:
   * 20 MB, 100,000 triangles, 64 million pixels. Default: false.
   */
  readonly untrusted?: boolean;
}

/** The URL of an avatar's file, the file, or its bytes. */
export type AvatarSource = string | URL | Blob | ArrayBuffer | ArrayBufferView;

/**
 * Loads an avatar from a URL, a file or its bytes: VRM 0.x or 1.0, or a humanoid GLB or FBX. Rejects with an Error that
 * names the file if it cannot be fetched or read, exceeds a limit, or lacks a needed bone. Pass `untrusted` for a file
 * that comes from another person.
 *
 * @example
 * const avatar = await loadAvatar('/avatars/robot.glb', { bones: { hips: 'Hips', head: 'Head' } });
 */
export async function loadAvatar(source: AvatarSource, options: LoadAvatarOptions = {}): Promise<Avatar> {
  assertOptions('loadAvatar', options, ['bones', 'untrusted']);
  const { bones, untrusted = false } = options;
  const { name, bytes } = await read(source);
  if (!untrusted) return createAvatar(await parseAvatar(bytes, name, { bones }));
  return loadUntrustedAvatar(bytes, name, { check: checkUntrusted, ...(bones && { bones }) });
}

/** Checks a file in a worker, or on the calling thread if no worker starts. */
const checkUntrusted = createWorkerCheck(startValidator, async (...file) => {
  const { checkAvatar } = await import('../avatar/file/check-avatar');
  return checkAvatar(...file);
});

/**
 * Loads the mannequin in this package; each call returns a new one.
 *
 * @example
 * const tracker = new BodyTracker(renderer, { avatar: await loadMannequin() });
 */
export async function loadMannequin(): Promise<Avatar> {
  return createAvatar(await parseAvatar(await readBundledMannequin(), 'mannequin.vrm', {}));
}

/**
 * Returns a writer of animated GLB files for the option `format` of `exportMotion`. The file contains the avatar and
 * the motion as an animation, with steps scaled to the avatar's legs. Rejects as `loadAvatar` does.
 *
 * @example
 * const { parts, type } = await exportMotion(recording, { format: await avatarMotionWriter('/avatars/me.vrm') });
 */
export async function avatarMotionWriter(
  source: AvatarSource,
  options: Pick<LoadAvatarOptions, 'bones'> = {},
): Promise<MotionWriter> {
  assertOptions('avatarMotionWriter', options, ['bones']);
  const { bones } = options;
  const [{ createAvatarMotionWriter }, { name, bytes }] = await Promise.all([
    import('../avatar/avatar-motion-writer'),
    read(source),
  ]);
  return createAvatarMotionWriter(bytes, name, { bones });
}

async function read(source: AvatarSource): Promise<{ name: string; bytes: ArrayBuffer }> {
  if (source instanceof ArrayBuffer) return { name: 'the avatar', bytes: source };
  if (ArrayBuffer.isView(source) || source instanceof Blob) {
    const name = source instanceof File ? source.name : 'the avatar';
    return { name, bytes: await new Blob([source as BlobPart]).arrayBuffer() };
  }
  if (typeof source !== 'string' && !(source instanceof URL)) {
    throw new TypeError(
      "The avatar's source is missing. Pass its address, file or bytes: loadAvatar('/avatars/me.vrm').",
    );
  }
  const address = String(source);
  const name = nameOfAddress(address);
  const response = await fetch(address).catch((error: unknown) => {
    throw new Error(`${name}: could not be fetched (${reasonOf(error)})`);
  });
  if (!response.ok) throw new Error(`${name}: the server answers ${response.status} ${response.statusText}`.trim());
  return { name, bytes: await response.arrayBuffer() };
}

export interface BodyTrackerOptions extends Omit<BodyOptions, 'events'> {
  /**
   * The avatar, from `loadAvatar`; the tracker owns it and disposes of it. Add `tracker.object` to the scene, or to the
   * group that moves the cameras.
   */
  readonly avatar: Avatar;
  /**
   * Whether to read the body that the device tracks (WebXR Body Tracking), which the estimator 'device' uses. The page
   * must request the session with the feature 'body-tracking'. Default: false.
   */
  readonly deviceBody?: boolean;
  /**
   * Returns the trackers beyond head and hands in each frame of a session, floor frame [m], for trackers that another
   * program sends; null: none is seen. They need `trackerOffsets` in the calibration, and the option `pinning`.
   */
  readonly trackers?: () => BodyTrackers | null;
  /** The URL of another contract (.json) of the learned network, next to its weights. */
  readonly modelUrl?: string | URL;
}

/** The events of a `BodyTracker` with their data; `BodyEvents` describes each. */
export interface BodyTrackerEvents {
  readonly calibrated: { readonly calibration: Calibration; readonly source: CalibrationSource };
  readonly heightmismatch: { readonly difference: number };
  readonly fallback: { readonly estimator: EstimatorName; readonly reason: string };
  readonly estimatorchange: object;
  readonly discontinuity: object;
  readonly trackinglost: { readonly point: TrackedPoint };
  readonly trackingfound: { readonly point: TrackedPoint };
  readonly trackermismatch: TrackerMismatch;
  readonly sessionstart: object;
  readonly sessionend: object;
}

const trackerOptions = [
  'avatar',
  'deviceBody',
  'trackers',
  'modelUrl',
  ...solverOptions.filter((name) => name !== 'events'),
];

/** The avatars that belong to a tracker, or were disposed of by one. */
const ownedAvatars = new WeakMap<Avatar, 'drawn' | 'disposed'>();

function assertRenderer(renderer: WebGLRenderer | undefined): void {
  if (renderer) return;
  throw new TypeError('renderer is missing. Pass the one that draws: new BodyTracker(renderer, { avatar }).');
}

/** Throws an Error if `avatar` is no avatar, or belongs to another tracker. */
function assertAvatar(avatar: unknown): asserts avatar is Avatar {
  const load = "avatar: await loadAvatar('/avatars/me.vrm')";
  if (avatar === undefined || avatar === null) throw new TypeError(`avatar is missing. Load one: ${load}.`);
  if (typeof avatar === 'string' || avatar instanceof URL) {
    throw new TypeError(`avatar is an address. Load it first: ${load}.`);
  }
  if (typeof (avatar as PromiseLike<unknown>).then === 'function') {
    throw new TypeError(`avatar is a promise. Await it: ${load}.`);
  }
  if (typeof (avatar as Avatar).setPose !== 'function') {
    throw new TypeError(`avatar is not from loadAvatar. Load one: ${load}.`);
  }
  const owned = ownedAvatars.get(avatar as Avatar);
  if (owned === 'drawn') {
    throw new Error('This avatar belongs to another BodyTracker. Load one for each tracker: await loadAvatar(source).');
  }
  if (owned === 'disposed') {
    throw new Error('This avatar was disposed of with its BodyTracker. Load it again: await loadAvatar(source).');
  }
}

/**
 * Draws the user's body in a three.js page: reads head and hands of the renderer's session, estimates the body and
 * poses the avatar. Call `update` in each animation frame before drawing.
 *
 * @example
 * const tracker = new BodyTracker(renderer, { avatar: await loadAvatar('/avatars/me.vrm') });
 * scene.add(tracker.object);
 * renderer.setAnimationLoop((timeMs, frame) => {
 *   tracker.update(timeMs, frame);
 *   renderer.render(scene, camera);
 * });
 */
export class BodyTracker extends EventDispatcher<BodyTrackerEvents> {
  readonly avatar: Avatar;
  /** The solver of this tracker: the selected and the unavailable estimators, and the network's backend. */
  readonly body: Body;
  readonly #renderer: WebGLRenderer;
  readonly #deviceBody: boolean;
  readonly #trackers: (() => BodyTrackers | null) | undefined;
  readonly #object = new Group();
  /** The renderer's session and its tracking; null: there is none. */
  #session: XRSession | null = null;
  #tracked: TrackedSession | null = null;
  /** Whether the avatar's head is hidden from the user's eyes. */
  #firstPerson = false;
  #disposed = false;
  /** The page's listeners to `fallback`; without one a failed network is reported on the console. */
  readonly #fallbackListeners = new Set<unknown>();

  /**
   * Throws a RangeError for a calibration that no person has or an unknown estimator; a TypeError for a missing avatar,
   * an unknown option or `trackers` without `pinning`; an Error for an avatar of another tracker.
   */
  constructor(renderer: WebGLRenderer, options: BodyTrackerOptions) {
    super();
    assertOptions('BodyTracker', options, trackerOptions);
    const { avatar, modelUrl, deviceBody = false, trackers, ...bodyOptions } = options;
    assertRenderer(renderer);
    assertAvatar(avatar);
    assertPinning(trackers, bodyOptions.pinning);
    this.avatar = avatar;
    this.#deviceBody = deviceBody;
    this.#trackers = trackers;
    this.#renderer = renderer;
    const networks =
      modelUrl === undefined
        ? {}
        : {
            networks: (name: string) =>
              name === 'learned' ? loadLearned({ modelUrl }) : Promise.reject(noRuntimeError),
          };
    const passes = (type: 'estimatorchange' | 'discontinuity' | 'sessionstart' | 'sessionend') => () =>
      this.dispatchEvent({ type });
    this.body = new Body({
      ...networks,
      ...bodyOptions,
      events: {
        calibrated: (calibration, source) => {
          avatar.setCalibration(calibration);
          this.dispatchEvent({ type: 'calibrated', calibration, source });
        },
        heightmismatch: (difference) => this.dispatchEvent({ type: 'heightmismatch', difference }),
        estimatorchange: passes('estimatorchange'),
        discontinuity: passes('discontinuity'),
        fallback: (estimator, reason) => {
          if (this.#fallbackListeners.size > 0) this.dispatchEvent({ type: 'fallback', estimator, reason });
          else warnOfFallback(estimator, reason);
        },
        trackinglost: (point) => this.dispatchEvent({ type: 'trackinglost', point }),
        trackingfound: (point) => this.dispatchEvent({ type: 'trackingfound', point }),
        trackermismatch: (mismatch) => this.dispatchEvent({ type: 'trackermismatch', ...mismatch }),
        sessionstart: passes('sessionstart'),
        sessionend: passes('sessionend'),
      },
    });
    ownedAvatars.set(avatar, 'drawn');
    avatar.setCalibration(this.body.calibration);
    this.#object.name = 'body';
    this.#object.add(avatar.object);
    this.#object.visible = false;
  }

  override addEventListener<T extends keyof BodyTrackerEvents>(
    type: T,
    listener: EventListener<BodyTrackerEvents[T], T, this>,
  ): void {
    if (type === 'fallback') this.#fallbackListeners.add(listener);
    super.addEventListener(type, listener);
  }

  override removeEventListener<T extends keyof BodyTrackerEvents>(
    type: T,
    listener: EventListener<BodyTrackerEvents[T], T, this>,
  ): void {
    if (type === 'fallback') this.#fallbackListeners.delete(listener);
    super.removeEventListener(type, listener);
  }

  /**
   * The object to add to the scene. Its origin is that of the renderer's reference space; it is visible while there is
   * a pose. `avatar.object` inside it is placed on the floor, also where the page has moved its user.
   */
  get object(): Object3D {
    return this.#object;
  }

  /**
   * The pose of the newest frame, floor frame [m]; null before the first, after a session and after `dispose`. The
   * floor is the space that the renderer requested, or where `recentre` moved it. The next frame overwrites the pose:
   * keep it with `copyAvatarPose`.
   */
  get pose(): AvatarPose | null {
    return this.body.pose;
  }

  get calibration(): Calibration {
    return this.body.calibration;
  }

  /** The estimator in use: 'ik' while a network loads, and after it failed. */
  get estimator(): EstimatorName {
    return this.body.estimator;
  }

  /** Selects the estimator. Resolves when it is in use, or after the event `fallback` because it is unavailable. */
  setEstimator(estimator: EstimatorName): Promise<void> {
    return this.body.setEstimator(estimator);
  }

  /** Sets the user's measures [m]; 'auto' estimates them. Throws a RangeError for measures that no person has. */
  calibrate(calibration: Calibration | 'auto'): void {
    this.body.calibrate(calibration);
  }

  /**
   * Solves and draws one animation frame; takes the arguments of the `setAnimationLoop` callback. Without a session the
   * avatar is hidden. Call it before the first await of the callback, or it throws an InvalidStateError.
   */
  update(timeMs: number, frame: XRFrame | null | undefined): void {
    if (this.#isDisposed()) return;
    const time = this.body.tick(timeMs);
    this.#followSession();
    const session = this.#tracked;
    // The renderer may still have the space of the session before: the first frame starts the tracking.
    if (!session || !frame || !session.start()) return;
    const tracked = session.read(frame, time);
    const { position, orientation } = session.floorPose;
    this.avatar.object.position.copy(position);
    this.avatar.object.quaternion.copy(orientation);
    const trackers = this.#trackers?.();
    this.#draw(tracked && trackers ? { ...tracked, trackers } : tracked, null);
  }

  /**
   * Solves and draws a tracking frame that the page supplies, floor frame [m, s]. `standIn`: the measures of another
   * person who moves the body, such as an actor or a recording.
   */
  updateFromFrame(frame: TrackingFrame | null, standIn: Calibration | null = null): void {
    if (this.#isDisposed()) return;
    this.#followSession();
    this.#draw(frame, standIn);
  }

  /**
   * Moves the floor's origin under the user, with −Z in the direction of view. The renderer's reference space moves
   * with it.
   */
  recentre(): void {
    if (this.#disposed) return;
    if (this.#tracked) this.#tracked.recentre();
    else this.body.discontinuity();
  }

  /**
   * Removes the listeners and disposes of the avatar. Later calls of `update` have no effect, and the first one warns.
   * Resolves when every network that was loaded for this body is released.
   */
  dispose(): Promise<void> {
    this.#disposed = true;
    this.#endTracking();
    this.#object.removeFromParent();
    this.avatar.dispose();
    ownedAvatars.set(this.avatar, 'disposed');
    return this.body.dispose();
  }

  /** Returns whether the tracker was disposed of; warns once if so. */
  #isDisposed(): boolean {
    if (this.#disposed) warnAfterDispose(this, 'BodyTracker');
    return this.#disposed;
  }

  #draw(tracked: TrackingFrame | null, standIn: Calibration | null): void {
    const pose = this.body.update(tracked, standIn);
    this.#setFirstPerson(this.#session !== null && standIn === null);
    if (!tracked || !pose) return;
    this.avatar.setPose(pose, tracked.time);
    this.#object.visible = true;
  }

  /** Starts tracking when the renderer has another session, and ends that of the previous one. */
  #followSession(): void {
    const session = this.#renderer.xr.getSession();
    if (session === this.#session) return;
    this.#endTracking();
    this.#session = session;
    this.#tracked =
      session &&
      new TrackedSession({
        session,
        drawing: this.#renderer.xr,
        bodyReader: this.#deviceBody ? new DeviceBodyReader() : null,
        onStart: () => this.body.startSession(),
        onDiscontinuity: () => this.body.discontinuity(),
        onEnd: () => this.#endTracking(),
      });
  }

  #endTracking(): void {
    if (!this.#session) return;
    this.#tracked?.dispose();
    this.#tracked = null;
    this.#session = null;
    this.#setFirstPerson(false);
    this.avatar.object.position.set(0, 0, 0);
    this.avatar.object.quaternion.identity();
    this.#object.visible = false;
    this.body.endSession();
  }

  /** Sets the first-person view only when it changes, because the page may set it as well. */
  #setFirstPerson(on: boolean): void {
    if (on === this.#firstPerson) return;
    this.#firstPerson = on;
    this.avatar.setFirstPerson(on);
  }
}

const noRuntimeError = new Error(
  'modelUrl: only the learned network runs without a runtime. Pass networks: onnxNetworks() of threepoint/onnx for the others.',
);
