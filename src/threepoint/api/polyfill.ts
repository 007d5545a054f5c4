// "threepoint/polyfill": WebXR Body Tracking for devices without it, estimated from head and hands.

import { reasonOf } from '../core/errors/reasons';
import { copyPose, invertTransform, makePose, type Pose, type Transform, transformPose } from '../core/math/pose';
import { type XRBodyJoints, XRBodyPoser } from '../core/motion/xr-body';
import { TrackedSession } from '../xr/tracked-session';
import { assertOptions } from './assert-options';
import { Body, type BodyOptions, bodyOptions as solverOptions } from './body';

export interface InstallBodyTrackingOptions extends BodyOptions {
  /**
   * Called with the reason when a session has no body because it has no floor, or when the estimator is unavailable and
   * inverse kinematics replaces it. Default: a warning on the console.
   */
  readonly onWarning?: (reason: string) => void;
}

/**
 * A joint of an emulated body, in place of an XRBodySpace: an `instanceof XRSpace` that the frame's `getPose` and
 * `fillPoses` accept.
 */
export interface EmulatedBodySpace extends XRSpace {
  readonly jointName: string;
}

/** An emulated body in place of an XRBody: the 83 joints by name, in the specification's order. */
export interface EmulatedBody extends ReadonlyMap<string, EmulatedBodySpace> {
  /** Marks a body whose joints are estimated from three points instead of tracked. */
  readonly emulated: true;
}

const feature = 'body-tracking';

type Place = Pose<'floor'>;
/** Transforms coordinates of any space into the floor frame; the type does not name the space. */
type FloorFrom = Transform<'floor', 'floor'>;

const matrixSize = 16;

/** Writes a column-major matrix, as WebXR does. */
function writeMatrix({ position, orientation: { x, y, z, w } }: Place, target: Float32Array, at: number): void {
  target[at] = 1 - 2 * (y * y + z * z);
  target[at + 1] = 2 * (x * y + z * w);
  target[at + 2] = 2 * (x * z - y * w);
  target[at + 3] = 0;
  target[at + 4] = 2 * (x * y - z * w);
  target[at + 5] = 1 - 2 * (x * x + z * z);
  target[at + 6] = 2 * (y * z + x * w);
  target[at + 7] = 0;
  target[at + 8] = 2 * (x * z + y * w);
  target[at + 9] = 2 * (y * z - x * w);
  target[at + 10] = 1 - 2 * (x * x + y * y);
  target[at + 11] = 0;
  target[at + 12] = position.x;
  target[at + 13] = position.y;
  target[at + 14] = position.z;
  target[at + 15] = 1;
}

type FillPoses = (spaces: Iterable<XRSpace>, base: XRSpace, transforms: Float32Array) => boolean;

interface Originals {
  readonly getPose: XRFrame['getPose'];
  readonly fillPoses: FillPoses | undefined;
}

/** The second spelling of a joint whose name in the specification is irregular; pages use both. */
const otherSpellings: Readonly<Record<string, string>> = {
  'left-hand-middle-phalanx-metacarpal': 'left-hand-middle-metacarpal',
};

class JointSpaces extends Map<string, EmulatedBodySpace> implements EmulatedBody {
  readonly emulated = true;

  constructor(jointNames: readonly string[]) {
    super();
    for (const name of jointNames) {
      const space = Object.create(XRSpace.prototype, { jointName: { value: name, enumerable: true } });
      this.set(name, space as EmulatedBodySpace);
    }
  }

  override get(name: string): EmulatedBodySpace | undefined {
    return super.get(otherSpellings[name] ?? name);
  }
}

/** The body of one session. It estimates the pose once per frame, when the page first reads it. */
class SessionBody {
  readonly spaces: EmulatedBody;
  readonly #session: XRSession;
  readonly #body: Body;
  readonly #originals: Originals;
  #floor: XRReferenceSpace | null = null;
  #tracked: TrackedSession | null = null;
  #poser: XRBodyPoser | null = null;
  #poserOf: object | null = null;
  /** The time stamp [ms] of the current frame, and of the frame that `#joints` belongs to. */
  #frameMs = Number.NaN;
  #estimatedMs = Number.NaN;
  #lastTime = Number.POSITIVE_INFINITY;
  /** The newest joints; null before the session's first frame with a head. */
  #joints: XRBodyJoints | null = null;
  /** The pose of the floor in the base space of the newest request, and that request; null: unknown. */
  readonly #baseFromFloor = makePose<'floor'>();
  #known: FloorFrom | null = null;
  #knownIn: { frame: XRFrame | null; frameMs: number; base: XRSpace | null } = {
    frame: null,
    frameMs: Number.NaN,
    base: null,
  };
  readonly #inFloor = makePose<'floor'>();
  readonly #inBase = makePose<'floor'>();

  constructor(session: XRSession, body: Body, originals: Originals, jointNames: readonly string[]) {
    this.#session = session;
    this.#body = body;
    this.#originals = originals;
    this.spaces = new JointSpaces(jointNames);
  }

  /** Starts tracking once the session has a floor. Rejects if it has none: the joints then have no poses. */
  async begin(): Promise<void> {
    const floor = await this.#session.requestReferenceSpace('local-floor');
    this.#floor = floor;
    this.#tracked = new TrackedSession({
      session: this.#session,
      // Estimates are in the floor's space, whichever one the page draws in.
      drawing: { getReferenceSpace: () => floor, setReferenceSpace: () => undefined },
      onStart: () => this.#body.startSession(),
      onDiscontinuity: () => this.#body.discontinuity(),
      onEnd: () => this.#end(),
    });
    this.#tracked.start();
  }

  #end(): void {
    this.#tracked = null;
    this.#body.endSession();
  }

  frame(timeMs: number): void {
    this.#frameMs = timeMs;
  }

  has(space: XRSpace): space is EmulatedBodySpace {
    return 'jointName' in space && this.spaces.get(space.jointName as string) === space;
  }

  /**
   * Returns the pose of a space in a base space, of which at least one is a joint; null: unknown. The next call
   * overwrites it.
   */
  pose(frame: XRFrame, space: XRSpace, base: XRSpace): Place | null {
    const inFloor = this.#locate(frame, space);
    const baseFromFloor = inFloor && this.#findBase(frame, base);
    return baseFromFloor && transformPose<'floor', 'floor'>(baseFromFloor, inFloor, this.#inBase);
  }

  /** Writes the matrices of all spaces. Writes NaN for unknown poses, and returns false if there is one. */
  fill(frame: XRFrame, spaces: readonly XRSpace[], base: XRSpace, transforms: Float32Array): boolean {
    let all = true;
    for (let i = 0; i < spaces.length; i++) {
      const place = this.pose(frame, spaces[i]!, base);
      if (place) writeMatrix(place, transforms, matrixSize * i);
      else transforms.fill(Number.NaN, matrixSize * i, matrixSize * (i + 1));
      all &&= place !== null;
    }
    return all;
  }

  /** Returns the pose of a space, floor frame; null: unknown. */
  #locate(frame: XRFrame, space: XRSpace): Place | null {
    if (!this.#floor) return null;
    if (this.has(space)) return this.#estimate(frame)?.get(space.jointName) ?? null;
    const pose = this.#originals.getPose.call(frame, space, this.#floor);
    return pose ? copyPose(pose.transform, this.#inFloor) : null;
  }

  /** Returns the pose of the floor in the base space, cached because pages read all joints in one base. */
  #findBase(frame: XRFrame, base: XRSpace): FloorFrom | null {
    const asked = this.#knownIn;
    if (asked.frame === frame && asked.frameMs === this.#frameMs && asked.base === base) return this.#known;
    asked.frame = frame;
    asked.frameMs = this.#frameMs;
    asked.base = base;
    this.#known = this.#locateFloor(frame, base);
    return this.#known;
  }

  #locateFloor(frame: XRFrame, base: XRSpace): FloorFrom | null {
    if (this.has(base)) {
      const joint = this.#locate(frame, base);
      return joint && invertTransform(joint, this.#baseFromFloor);
    }
    const pose = this.#floor && this.#originals.getPose.call(frame, this.#floor, base);
    return pose ? copyPose(pose.transform, this.#baseFromFloor) : null;
  }

  #estimate(frame: XRFrame): XRBodyJoints | null {
    if (this.#estimatedMs === this.#frameMs || !this.#tracked) return this.#joints;
    this.#estimatedMs = this.#frameMs;
    const time = this.#body.tick(this.#frameMs);
    const tracked = this.#tracked.read(frame, time);
    const pose = this.#body.solve(tracked);
    // One body serves all sessions: until this session has a head, the pose is that of the previous session.
    if (!tracked) return this.#joints;
    const { calibration } = this.#body;
    if (this.#poserOf !== calibration) {
      this.#poser = new XRBodyPoser(calibration);
      this.#poserOf = calibration;
    }
    const seconds = Math.max(time - this.#lastTime, 0);
    this.#lastTime = time;
    this.#joints = pose?.body && this.#poser ? this.#poser.pose(pose.body, tracked.fingers, seconds) : null;
    return this.#joints;
  }
}

const asXRPose = ({ position, orientation }: Place): XRPose => ({
  transform: new XRRigidTransform({ ...position, w: 1 }, orientation),
  emulatedPosition: true,
});

/** Returns the session's options with the body as an optional feature, and the floor that an estimate needs. */
function sessionOptions(init: XRSessionInit): XRSessionInit {
  const required = (init.requiredFeatures ?? []).filter((name) => name !== feature);
  const optional = new Set([...(init.optionalFeatures ?? []), feature, 'local-floor']);
  return { ...init, requiredFeatures: required, optionalFeatures: [...optional] };
}

const requestsBody = ({ requiredFeatures = [], optionalFeatures = [] }: XRSessionInit): boolean =>
  [...requiredFeatures, ...optionalFeatures].includes(feature);

/** Replaces a property and returns the function that restores it. */
function replace(object: object, name: string, descriptor: PropertyDescriptor): () => void {
  const before = Object.getOwnPropertyDescriptor(object, name);
  Object.defineProperty(object, name, { configurable: true, ...descriptor });
  return () => {
    if (before) Object.defineProperty(object, name, before);
    else Reflect.deleteProperty(object, name);
  };
}

function patchFrames(bodies: WeakMap<XRSession, SessionBody>, { getPose, fillPoses }: Originals): (() => void)[] {
  const frames = XRFrame.prototype;
  const native = Object.getOwnPropertyDescriptor(frames, 'body');
  return [
    replace(frames, 'body', {
      get(this: XRFrame) {
        return bodies.get(this.session)?.spaces ?? native?.get?.call(this) ?? null;
      },
    }),
    replace(frames, 'getPose', {
      writable: true,
      value(this: XRFrame, space: XRSpace, base: XRSpace): XRPose | undefined {
        const body = bodies.get(this.session);
        if (!body || !(body.has(space) || body.has(base))) return getPose.call(this, space, base);
        const pose = body.pose(this, space, base);
        return (pose ? asXRPose(pose) : null) as XRPose | undefined;
      },
    }),
    replace(frames, 'fillPoses', {
      writable: true,
      value(this: XRFrame, spaces: Iterable<XRSpace>, base: XRSpace, transforms: Float32Array): boolean {
        const all = [...spaces];
        const body = bodies.get(this.session);
        if (body && (body.has(base) || all.some((space) => body.has(space))))
          return body.fill(this, all, base, transforms);
        if (fillPoses) return fillPoses.call(this, all, base, transforms);
        const poses = all.map((space) => getPose.call(this, space, base));
        for (const [i, pose] of poses.entries()) if (pose) transforms.set(pose.transform.matrix, matrixSize * i);
        return poses.every(Boolean);
      },
    }),
    patchClock(bodies),
  ];
}

/** Passes the time stamp of each frame to the body of its session. */
function patchClock(bodies: WeakMap<XRSession, SessionBody>): () => void {
  const { requestAnimationFrame } = XRSession.prototype;
  return replace(XRSession.prototype, 'requestAnimationFrame', {
    writable: true,
    value(this: XRSession, callback: XRFrameRequestCallback): number {
      return requestAnimationFrame.call(this, (timeMs, frame) => {
        bodies.get(this)?.frame(timeMs);
        callback(timeMs, frame);
      });
    },
  });
}

/** Warns that joints have no pose, for a page that does not handle `onWarning`. */
function warnOfMissingBody(reason: string): void {
  console.warn(`threepoint: the session has no body: ${reason}. Handle “onWarning” to report it yourself.`);
}

/** The names of the options that are passed on to the body. */
const trackingOptions = ['onWarning', ...solverOptions];

/**
 * Adds `frame.body` to the sessions that request the feature “body-tracking”: the device's own body, else one that is
 * estimated from head and hands. An estimated body is marked by `emulated`, its poses by `emulatedPosition`. Call it
 * before the first session is requested, and after a WebXR emulator was installed. Returns a function that uninstalls
 * it. Throws an Error where the page has no WebXR (or Node runs it), a RangeError where the calibration is not human, a
 * TypeError where an option is unknown.
 *
 * @example
 * const uninstall = installBodyTracking({ onWarning: console.warn });
 */
export function installBodyTracking(options: InstallBodyTrackingOptions = {}): () => void {
  const xr = globalThis.navigator?.xr;
  if (!xr) {
    throw new Error(
      'installBodyTracking: there is no navigator.xr here. Call it in a browser with WebXR, on a page of https: or localhost.',
    );
  }
  assertOptions('installBodyTracking', options, trackingOptions);
  const { onWarning, ...bodyOptions } = options;
  const body = new Body(bodyOptions);
  if (onWarning) {
    body.addEventListener('fallback', (event) => {
      event.preventDefault();
      onWarning(event.reason);
    });
  }
  const warn = onWarning ?? warnOfMissingBody;
  const jointNames = [...new XRBodyPoser(body.calibration).names];
  const bodies = new WeakMap<XRSession, SessionBody>();
  const { getPose, fillPoses } = XRFrame.prototype as XRFrame & { readonly fillPoses?: FillPoses };
  const originals: Originals = { getPose, fillPoses };
  const request = xr.requestSession;
  const undo = [
    ...patchFrames(bodies, originals),
    replace(xr, 'requestSession', {
      writable: true,
      async value(mode: XRSessionMode, init: XRSessionInit = {}): Promise<XRSession> {
        if (!requestsBody(init)) return request.call(xr, mode, init);
        const session = await request.call(xr, mode, sessionOptions(init));
        const enabled = session.enabledFeatures ?? [];
        if (enabled.includes(feature) && 'XRBody' in globalThis) return session;
        const emulated = new SessionBody(session, body, originals, jointNames);
        bodies.set(session, emulated);
        replace(session, 'enabledFeatures', { value: [...new Set([...enabled, feature])] });
        emulated
          .begin()
          .catch((error: unknown) => warn(`the session has no floor-level reference space: ${reasonOf(error)}`));
        return session;
      },
    }),
  ];
  return () => {
    for (const put of undo.reverse()) put();
    void body.dispose();
  };
}
