import { Group, type Object3D } from 'three';
import type { Avatar } from '../avatar/avatar';
import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import type { DefaultMethod, PaperMethod } from '../core/estimation/pose-estimator';
import { assertPinning, type BodyTrackers, type TrackingFrame } from '../core/tracking/tracking-frame';
import { DeviceBodyReader } from '../xr/device-body-reader';
import type { Pointing } from '../xr/pointing';
import { type DrawingSpace, TrackedSession } from '../xr/tracked-session';
import { assertOptions } from './assert-options';
import { Body, type BodyOptions, internalOptions, type LoadNetwork, bodyOptions as solverOptions } from './body';
import type { BodyEvent, BodyEvents } from './body-events';
import type { TypedEventTarget } from './event-target';
import { loadLearned } from './load-learned';
import { warnAfterDispose, warnOfXrDisabled } from './warnings';

/** The part of a three.js renderer that a tracker uses: `WebGLRenderer` and `WebGPURenderer` have it. */
export interface XrRenderer {
  readonly xr: DrawingSpace & { readonly enabled: boolean; getSession(): XRSession | null };
}

export interface BodyTrackerOptions<Shown extends Avatar | null = Avatar, Method extends PaperMethod = never>
  extends BodyOptions<Method> {
  /**
   * The avatar, from `loadAvatar`; null: `setAvatar` follows. The tracker owns it and disposes of it. Add
   * `tracker.object` to the scene, or to the group that moves the cameras.
   */
  readonly avatar: Shown;
  /** Whether the tracker disposes of avatars that it no longer draws. Default: true. */
  readonly disposeAvatar?: boolean;
  /**
   * Whether to read the body that the device tracks (WebXR Body Tracking), which the estimator 'device' uses. The page
   * must request the session with the feature 'body-tracking'. Default: false.
   */
  readonly deviceBody?: boolean;
  /** Creates the reader of what the input sources of a session point at and press: `Pointing` of threepoint/webxr. */
  readonly pointing?: (session: XRSession) => Pointing;
  /**
   * Returns the trackers beyond head and hands in each frame of a session, floor frame [m], for trackers that another
   * program sends; null: none is seen. They need `trackerOffsets` in the calibration, and the option `pinning`.
   */
  readonly trackers?: () => BodyTrackers | null;
  /** The URL of another contract (.json) of the learned network, next to its weights. */
  readonly modelUrl?: string | URL;
}

const trackerOptions = ['avatar', 'disposeAvatar', 'deviceBody', 'pointing', 'trackers', 'modelUrl', ...solverOptions];

/** The avatars that belong to a tracker, or were disposed of by one. */
const ownedAvatars = new WeakMap<Avatar, 'drawn' | 'disposed'>();

function assertRenderer(renderer: XrRenderer | undefined): void {
  if (renderer?.xr) return;
  const what = renderer ? 'no renderer of three.js: it has no “xr”' : 'missing';
  throw new TypeError(`renderer is ${what}. Pass the one that draws: new BodyTracker(renderer, { avatar }).`);
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
export class BodyTracker<Shown extends Avatar | null = Avatar, Method extends PaperMethod = never>
  implements TypedEventTarget<BodyEvents>
{
  /**
   * The object to add to the scene. Its origin is that of the renderer's reference space; it is visible while there is
   * a pose. `avatar.object` inside it is placed on the floor, also where the page has moved its user.
   */
  readonly object: Object3D = new Group();
  /** The solver of this tracker: the selected and the unavailable estimators, and the network's backend. */
  readonly body: Body<Method>;
  /** Whether the body that the device tracks is read in the sessions that start from now on. */
  deviceBody: boolean;
  readonly #renderer: XrRenderer;
  readonly #pointing: ((session: XRSession) => Pointing) | undefined;
  readonly #trackers: (() => BodyTrackers | null) | undefined;
  /** The renderer's session and its tracking; null: there is none. */
  #session: XRSession | null = null;
  #tracking: TrackedSession | null = null;
  #avatar: Shown;
  readonly #disposesAvatars: boolean;
  /** Whether the avatar's head is hidden from the user's eyes. */
  #firstPerson = false;
  #disposed = false;

  /**
   * Throws a RangeError for a calibration that no person has or an unknown estimator; a TypeError for a missing avatar,
   * an unknown option or `trackers` without `pinning`; an Error for an avatar of another tracker.
   */
  constructor(renderer: XrRenderer, options: BodyTrackerOptions<Shown, Method>) {
    assertRenderer(renderer);
    assertOptions('BodyTracker', options, trackerOptions, internalOptions);
    const { avatar, disposeAvatar = true, modelUrl, deviceBody = false, pointing, trackers, ...bodyOptions } = options;
    if (avatar !== null) assertAvatar(avatar);
    assertPinning(trackers, bodyOptions.pinning);
    this.#avatar = avatar;
    this.#disposesAvatars = disposeAvatar;
    this.deviceBody = deviceBody;
    this.#pointing = pointing;
    this.#trackers = trackers;
    this.#renderer = renderer;
    this.body = new Body<Method>({ ...(modelUrl !== undefined && { networks: learnedAt(modelUrl) }), ...bodyOptions });
    this.body.addEventListener('calibrated', ({ calibration }) => this.#avatar?.setCalibration(calibration));
    this.object.name = 'body';
    this.object.visible = false;
    if (avatar !== null) this.#own(avatar);
  }

  /** The avatar that is drawn; null until `setAvatar`, for a tracker that was created without one. */
  get avatar(): Shown {
    return this.#avatar;
  }

  /**
   * Draws another avatar from the next frame on and disposes of the one before, unless `disposeAvatar` is false. Body,
   * measures and session continue. A tracker that was disposed of disposes of it at once. Throws an Error for an avatar
   * of another tracker.
   */
  setAvatar(avatar: Avatar & Shown): void {
    assertAvatar(avatar);
    if (this.#disposed) {
      if (this.#disposesAvatars) avatar.dispose();
      return;
    }
    this.#releaseAvatar();
    this.#avatar = avatar;
    this.#own(avatar);
    avatar.setFirstPerson(this.#firstPerson);
  }

  addEventListener<Name extends keyof BodyEvents>(
    type: Name,
    listener: (event: BodyEvent<Name>) => void,
    options?: AddEventListenerOptions,
  ): void {
    this.body.addEventListener(type, listener, options);
  }

  removeEventListener<Name extends keyof BodyEvents>(type: Name, listener: (event: BodyEvent<Name>) => void): void {
    this.body.removeEventListener(type, listener);
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
  get estimator(): DefaultMethod | Method {
    return this.body.estimator;
  }

  /** Selects the estimator. Resolves when it is in use, or after the event `fallback` because it is unavailable. */
  setEstimator(estimator: DefaultMethod | Method): Promise<void> {
    return this.body.setEstimator(estimator);
  }

  /** Sets the user's measures [m]; 'auto' estimates them. Throws a RangeError for measures that no person has. */
  calibrate(calibration: Calibration | 'auto'): void {
    this.body.calibrate(calibration);
  }

  /**
   * Solves and draws one animation frame; takes the arguments of the `setAnimationLoop` callback. `change` receives its
   * head and hands and returns those to draw, floor frame [m]. Without a session the avatar is hidden. Call it before
   * the first await of the callback, or it throws an InvalidStateError.
   */
  update(
    timeMs: number,
    frame: XRFrame | null | undefined,
    change: (tracked: TrackingFrame) => TrackingFrame = unchanged,
  ): void {
    if (this.#isDisposed()) return;
    const time = this.body.tick(timeMs);
    this.#followSession();
    // The renderer may still have the space of the session before: the first frame starts the tracking.
    if (!frame || !this.#tracking?.start()) return;
    const read = this.read(frame, time);
    const tracked = read && change(read);
    if (tracked === read) this.body.solve(tracked);
    else this.body.update(tracked);
    this.#show(tracked, null);
  }

  /**
   * Solves and draws a tracking frame that the page supplies, floor frame [m, s]. `standIn`: the measures of another
   * person who moves the body, such as an actor or a recording.
   */
  updateFromFrame(frame: TrackingFrame | null, standIn: Calibration | null = null): void {
    if (this.#isDisposed()) return;
    this.#followSession();
    this.body.update(frame, standIn);
    this.#show(frame, standIn);
  }

  /**
   * The tracking of the renderer's session, with its buttons, pointers and floor; null without a session, and before
   * its first frame.
   */
  get tracking(): TrackedSession | null {
    return this.#tracking;
  }

  /**
   * Returns head and hands of a session's frame, floor frame [m], at the `time` [s] of `body.tick`; null while the head
   * is not seen. A page that measures the steps of a frame calls `read`, `body.solve` and `draw` instead of `update`.
   *
   * @internal
   */
  read(frame: XRFrame, time: number): TrackingFrame | null {
    this.#followSession();
    const tracking = this.#tracking;
    if (!tracking) return null;
    const tracked = tracking.read(frame, time);
    const { position, orientation } = tracking.floorPose;
    this.#avatar?.object.position.copy(position);
    this.#avatar?.object.quaternion.copy(orientation);
    const trackers = this.#trackers?.();
    return tracked && trackers ? { ...tracked, trackers } : tracked;
  }

  /**
   * Poses the avatar by the body's newest pose, at a time [s]. Without a pose nothing changes.
   *
   * @internal
   */
  draw(time: number): void {
    const { pose } = this.body;
    const avatar = this.#avatar;
    if (!pose || !avatar) return;
    avatar.setPose(pose, time);
    this.object.visible = true;
  }

  /**
   * Moves the floor's origin under the user, with −Z in the direction of view. The renderer's reference space moves
   * with it.
   */
  recentre(): void {
    if (this.#disposed) return;
    if (this.#tracking) this.#tracking.recentre();
    else this.body.discontinuity();
  }

  /**
   * Ends the events and disposes of the avatar, unless `disposeAvatar` is false. Later calls of `update` have no
   * effect, and the first one warns. Resolves when every network that was loaded for this body is released.
   */
  dispose(): Promise<void> {
    this.#disposed = true;
    this.#endTracking();
    this.object.removeFromParent();
    this.#releaseAvatar();
    return this.body.dispose();
  }

  #own(avatar: Avatar): void {
    ownedAvatars.set(avatar, 'drawn');
    avatar.setCalibration(this.body.calibration);
    this.object.add(avatar.object);
  }

  /** Disposes of the avatar, or returns it to the page as it was. */
  #releaseAvatar(): void {
    const avatar = this.#avatar;
    if (!avatar) return;
    if (this.#disposesAvatars) {
      avatar.dispose();
      ownedAvatars.set(avatar, 'disposed');
      return;
    }
    avatar.object.removeFromParent();
    avatar.setFirstPerson(false);
    ownedAvatars.delete(avatar);
  }

  /** Returns whether the tracker was disposed of; warns once if so. */
  #isDisposed(): boolean {
    if (this.#disposed) warnAfterDispose(this, 'BodyTracker');
    return this.#disposed;
  }

  #show(frame: TrackingFrame | null, standIn: Calibration | null): void {
    this.#setFirstPerson(this.#session !== null && standIn === null);
    if (frame) this.draw(frame.time);
  }

  /** Starts tracking when the renderer has another session, and ends that of the previous one. */
  #followSession(): void {
    const { xr } = this.#renderer;
    const session = xr.getSession();
    if (session === this.#session) return;
    if (session && !xr.enabled) warnOfXrDisabled(this.#renderer);
    this.#endTracking();
    this.#session = session;
    this.#tracking =
      session &&
      new TrackedSession({
        session,
        drawing: xr,
        bodyReader: this.deviceBody ? new DeviceBodyReader() : null,
        pointing: this.#pointing?.(session) ?? null,
        gripOffsets: () => this.body.userCalibration.gripOffsets,
        onStart: () => this.body.startSession(),
        onDiscontinuity: () => this.body.discontinuity(),
        onEnd: () => this.#endTracking(),
      });
  }

  #endTracking(): void {
    if (!this.#session) return;
    this.#tracking?.dispose();
    this.#tracking = null;
    this.#session = null;
    this.#setFirstPerson(false);
    this.#avatar?.object.position.set(0, 0, 0);
    this.#avatar?.object.quaternion.identity();
    this.object.visible = false;
    this.body.endSession();
  }

  /** Sets the first-person view only when it changes, because the page may set it as well. */
  #setFirstPerson(on: boolean): void {
    if (on === this.#firstPerson) return;
    this.#firstPerson = on;
    this.#avatar?.setFirstPerson(on);
  }
}

const unchanged = (tracked: TrackingFrame): TrackingFrame => tracked;

/** Returns a loader of the learned network with another contract. */
const learnedAt =
  (modelUrl: string | URL): LoadNetwork =>
  async (name) => {
    if (name === 'learned') return loadLearned({ modelUrl });
    throw new Error(
      'modelUrl: only the learned network runs without a runtime. Pass networks: onnxNetworks() of threepoint/onnx for the others.',
    );
  };
