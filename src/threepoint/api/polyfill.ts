// "threepoint/polyfill": the body of WebXR Body Tracking, estimated from head and hands, where a device has none.

import { reasonOf } from '../core/errors/reasons';
import { copyPose, invertTransform, makePose, type Pose, type Transform, transformPose } from '../core/math/pose';
import { type XRBodyJoints, XRBodyPoser } from '../core/motion/xr-body';
import { TrackedSession } from '../xr/tracked-session';
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

const matrixSize = 16;

/** Column by column, as WebXR has it. */
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
  #tracked: TrackedSession | null = null;
  #poser: XRBodyPoser | null = null;
  #poserOf: object | null = null;
  /** When the frame at hand began [ms], and of which the joints are. */
  #frameMs = Number.NaN;
  #estimatedMs = Number.NaN;
  #lastTime = Number.POSITIVE_INFINITY;
  /** null before the session's first frame that saw the head. */
  #joints: XRBodyJoints | null = null;
  /** Where the floor lies in the base that was asked for last, and in which frame; null: not known. */
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

  /** Starts tracking once the session has a floor; rejects where it has none: then there are joints, but no poses of them. */
  async begin(): Promise<void> {
    const floor = await this.#session.requestReferenceSpace('local-floor');
    this.#floor = floor;
    this.#tracked = new TrackedSession({
      session: this.#session,
      // The page draws where it likes: estimates are in the floor's space.
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

  /** The pose of one space in another, of which one or both are joints, overwritten by the next; null: not known. */
  pose(frame: XRFrame, space: XRSpace, base: XRSpace): Place | null {
    const inFloor = this.#locate(frame, space);
    const baseFromFloor = inFloor && this.#findBase(frame, base);
    return baseFromFloor && transformPose<'floor', 'floor'>(baseFromFloor, inFloor, this.#inBase);
  }

  /** The matrices of all spaces; false, and no number, where one is not known. */
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

  /** Floor frame. */
  #locate(frame: XRFrame, space: XRSpace): Place | null {
    if (!this.#floor) return null;
    if (this.has(space)) return this.#estimate(frame)?.get(space.jointName) ?? null;
    const pose = this.#originals.getPose.call(frame, space, this.#floor);
    return pose ? copyPose(pose.transform, this.#inFloor) : null;
  }

  /** Pages ask for joint after joint in one base. */
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
    const pose = this.#body.update(tracked);
    // One body serves all sessions: until this one sees the head, its pose is of the session before.
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
