// "threepoint/polyfill": the body of WebXR Body Tracking, estimated from head and hands, where a device has none.

import { reasonOf } from '../core/errors/reasons';
import { invertTransform, type Pose, type Transform, transformPose } from '../core/math/pose';
import { type XRBodyJoints, XRBodyPoser } from '../core/motion/xr-body';
import { createTracker, type Tracker } from '../xr/tracker';
import { Body, type BodyOptions } from './body';

export interface BodyTrackingOptions extends Omit<BodyOptions, 'events' | 'clock' | 'timing'> {
  /** Hears why a session has no body: no floor, or the wanted method is not to be had (inverse kinematics draws then). */
  readonly onFault?: (reason: string) => void;
}

/** One joint of an emulated body, in place of an XRBodySpace: `instanceof XRSpace`, and understood by the frame's `getPose` and `fillPoses`. */
export interface EmulatedBodySpace extends XRSpace {
  readonly jointName: string;
}

/** In place of an XRBody: the 83 joints by name, in the specification's order. */
export interface EmulatedBody extends ReadonlyMap<string, EmulatedBodySpace> {
  /** Estimated from three points: no device has seen these joints. */
  readonly emulated: true;
}

const feature = 'body-tracking';

type Place = Pose<'floor'>;
/** Coordinates in the floor frame from those in any space: which one is not told by its type. */
type FloorFrom = Transform<'floor', 'floor'>;

const placeOf = ({ transform: { position, orientation } }: XRPose): Place => ({
  position: { x: position.x, y: position.y, z: position.z },
  orientation: { x: orientation.x, y: orientation.y, z: orientation.z, w: orientation.w },
});

type FillPoses = (spaces: Iterable<XRSpace>, base: XRSpace, transforms: Float32Array) => boolean;

/** What a page calls, as the browser made it. */
interface Originals {
  readonly getPose: XRFrame['getPose'];
  readonly fillPoses: FillPoses | undefined;
}

/** The specification's list spells one joint otherwise than its fellows; pages ask for it by either name. */
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

/** The body of one session: one estimate for each of its frames, made when it is asked for. */
class SessionBody {
  readonly spaces: EmulatedBody;
  readonly #session: XRSession;
  readonly #body: Body;
  readonly #originals: Originals;
  #floor: XRReferenceSpace | null = null;
  #tracker: Tracker | null = null;
  #poser: XRBodyPoser | null = null;
  #poserOf: object | null = null;
  /** When the frame at hand began [ms], and of which the joints are. */
  #frameMs = Number.NaN;
  #estimatedMs = Number.NaN;
  #lastTime = Number.POSITIVE_INFINITY;
  #joints: XRBodyJoints | null = null;

  constructor(session: XRSession, body: Body, originals: Originals, jointNames: readonly string[]) {
    this.#session = session;
    this.#body = body;
    this.#originals = originals;
    this.spaces = new JointSpaces(jointNames);
  }

  /** Without a floor there are joints, but no poses of them. */
  async begin(): Promise<void> {
    this.#floor = await this.#session.requestReferenceSpace('local-floor');
    this.#tracker = createTracker(this.#session, this.#floor);
    this.#floor.addEventListener('reset', this.#jumped);
    this.#body.begin();
  }

  end(): void {
    this.#floor?.removeEventListener('reset', this.#jumped);
    this.#tracker?.dispose();
    this.#tracker = null;
    this.#body.forgetPoints();
  }

  frame(timeMs: number): void {
    this.#frameMs = timeMs;
  }

  has(space: XRSpace): space is EmulatedBodySpace {
    return 'jointName' in space && this.spaces.get(space.jointName as string) === space;
  }

  /** The pose of one space in another, of which one or both are joints; null: not known. */
  pose(frame: XRFrame, space: XRSpace, base: XRSpace): Place | null {
    const inFloor = this.#inFloor(frame, space);
    if (!inFloor || !this.#floor) return null;
    if (this.has(base)) {
      const joint = this.#inFloor(frame, base);
      return joint && transformPose<'floor', 'floor'>(invertTransform<'floor', 'floor'>(joint as FloorFrom), inFloor);
    }
    const floorInBase = this.#originals.getPose.call(frame, this.#floor, base);
    return floorInBase ? transformPose<'floor', 'floor'>(placeOf(floorInBase) as FloorFrom, inFloor) : null;
  }

  readonly #jumped = () => this.#body.jumped();

  #inFloor(frame: XRFrame, space: XRSpace): Place | null {
    if (!this.#floor) return null;
    if (this.has(space)) return this.#estimate(frame)?.get(space.jointName) ?? null;
    const pose = this.#originals.getPose.call(frame, space, this.#floor);
    return pose ? placeOf(pose) : null;
  }

  #estimate(frame: XRFrame): XRBodyJoints | null {
    if (this.#estimatedMs === this.#frameMs || !this.#tracker) return this.#joints;
    this.#estimatedMs = this.#frameMs;
    const time = this.#body.frame(this.#frameMs);
    const tracked = this.#tracker.read(frame, time);
    const pose = this.#body.update(tracked);
    const { calibration } = this.#body;
    if (this.#poserOf !== calibration) {
      this.#poser = new XRBodyPoser(calibration);
      this.#poserOf = calibration;
    }
    const seconds = Math.max(time - this.#lastTime, 0);
    this.#lastTime = time;
    this.#joints = pose?.body && this.#poser ? this.#poser.pose(pose.body, tracked?.fingers, seconds) : null;
    return this.#joints;
  }
}

/** As the frame gives poses. */
const asXRPose = ({ position, orientation }: Place): XRPose => ({
  transform: new XRRigidTransform({ ...position, w: 1 }, orientation),
  emulatedPosition: true,
});

/** What a session is asked for: the body where it can be had, and the floor that an estimate needs. */
function wishes(init: XRSessionInit): XRSessionInit {
  const required = (init.requiredFeatures ?? []).filter((name) => name !== feature);
  const optional = new Set([...(init.optionalFeatures ?? []), feature, 'local-floor']);
  return { ...init, requiredFeatures: required, optionalFeatures: [...optional] };
}

const asks = ({ requiredFeatures = [], optionalFeatures = [] }: XRSessionInit): boolean =>
  [...requiredFeatures, ...optionalFeatures].includes(feature);

/** Replaces a property until it is put back. */
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
        if (fillPoses && !(body && (body.has(base) || all.some((space) => body.has(space)))))
          return fillPoses.call(this, all, base, transforms);
        const poses = all.map((space) => this.getPose(space, base));
        for (const [i, pose] of poses.entries()) if (pose) transforms.set(pose.transform.matrix, 16 * i);
        return poses.every(Boolean);
      },
    }),
    patchClock(bodies),
  ];
}

/** Tells a session's body when each of its frames begins. */
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

/**
 * From now on sessions that ask for the feature “body-tracking” have `frame.body`: the device's own, else one that is estimated from head and hands and
 * says so (`emulated`; of its poses `emulatedPosition`). Call it before the first session is asked for; where a page emulates WebXR, after that.
 * Returns what takes it back. Throws an Error where the page has no WebXR, a RangeError where the calibration is no person's.
 */
export function installBodyTracking({ onFault, ...options }: BodyTrackingOptions = {}): () => void {
  const { xr } = navigator;
  if (!xr) throw new Error('installBodyTracking: this page has no WebXR');
  const body = new Body({ ...options, events: { fallback: (_, reason) => onFault?.(reason) } });
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
        if (!asks(init)) return request.call(xr, mode, init);
        const session = await request.call(xr, mode, wishes(init));
        const enabled = session.enabledFeatures ?? [];
        if (enabled.includes(feature) && 'XRBody' in globalThis) return session;
        const emulated = new SessionBody(session, body, originals, jointNames);
        bodies.set(session, emulated);
        replace(session, 'enabledFeatures', { value: [...new Set([...enabled, feature])] });
        session.addEventListener('end', () => emulated.end());
        emulated.begin().catch((error: unknown) => onFault?.(`no floor to stand on: ${reasonOf(error)}`));
        return session;
      },
    }),
  ];
  return () => {
    for (const put of undo.reverse()) put();
    void body.dispose();
  };
}
