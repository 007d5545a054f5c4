import { vi } from 'vitest';
import { composeTransforms, invertTransform, type Pose, transformPose } from '../../../src/threepoint/core/math/pose';
import { identity, type Quat, rotate } from '../../../src/threepoint/core/math/quat';
import type { Side } from '../../../src/threepoint/core/math/side';
import { type Vec3, vec3, zero } from '../../../src/threepoint/core/math/vec3';
import { Pointing } from '../../../src/threepoint/xr/pointing';
import { type DrawingSpace, TrackedSession } from '../../../src/threepoint/xr/tracked-session';

type Place = Pose<'floor'>;
export type Seen = (Place & { readonly emulated?: boolean }) | null;

/** A space of a device with a scripted origin in the room. */
class Space extends EventTarget {
  constructor(public roomFromSpace: Place) {
    super();
  }
  get at(): Seen {
    return this.roomFromSpace;
  }
  getOffsetReferenceSpace(origin: { readonly place: Place }): Space {
    return new Space(composeTransforms<'floor', 'floor', 'floor'>(this.roomFromSpace, origin.place));
  }
}

class RigidTransform {
  readonly place: Place;
  constructor(
    { x = 0, y = 0, z = 0 }: { x?: number; y?: number; z?: number },
    { x: a, y: b, z: c, w }: { x: number; y: number; z: number; w: number },
  ) {
    this.place = { position: { x, y, z }, orientation: { x: a, y: b, z: c, w } };
  }
  get position(): Vec3 {
    return this.place.position;
  }
  get orientation(): Quat {
    return this.place.orientation;
  }
  get matrix(): Float32Array {
    return Float32Array.from(matrixOf(this.place));
  }
}

export interface Input {
  readonly handedness: XRHandedness;
  readonly targetRayMode: XRTargetRayMode;
  readonly targetRaySpace: { at: Seen };
  readonly profiles: readonly string[];
  readonly gripSpace: { at: Seen };
  readonly hand?: Map<string, { at: Seen }>;
  readonly gamepad: {
    readonly buttons: { value: number; touched?: boolean; pressed?: boolean }[];
    readonly axes: number[];
  };
}

/** The part of a session that is read. */
class Session extends EventTarget {
  inputSources: Input[] = [];
  visibilityState: XRVisibilityState = 'visible';
}

/** A WebXR headset for tests: every pose is scripted, and may be null, emulated or not finite. */
export function fakeHeadset() {
  vi.stubGlobal('XRRigidTransform', RigidTransform);
  const floor = new Space({ position: zero, orientation: identity });
  const session = new Session();
  let head: Seen = { position: { x: 0, y: 1.6, z: 0 }, orientation: identity };
  const poseIn = (space: Space, at: Seen) => {
    if (!at) return null;
    const transform = transformPose<'floor', 'floor'>(invertTransform<'floor', 'floor'>(space.roomFromSpace), at);
    return { transform, emulatedPosition: at.emulated ?? false };
  };
  const frame = {
    getViewerPose: (space: Space) => poseIn(space, head),
    getPose: (of: { at: Seen }, space: Space) => poseIn(space, of.at),
    getJointPose: (of: { at: Seen }, space: Space) => {
      poseCalls.joints += 1;
      return poseIn(space, of.at);
    },
    fillPoses: (spaces: readonly { at: Seen }[], space: Space, matrices: Float32Array) => {
      poseCalls.fills += 1;
      const poses = spaces.map((of) => poseIn(space, of.at));
      matrices.fill(Number.NaN);
      if (poses.includes(null)) return false;
      for (const [i, pose] of poses.entries()) matrices.set(matrixOf(pose!.transform), 16 * i);
      return true;
    },
  };
  /** The numbers of calls of getJointPose and fillPoses. */
  const poseCalls = { joints: 0, fills: 0 };
  /** The spaces that the renderer was set to draw in, in order. */
  const spaces: XRReferenceSpace[] = [];
  let drawnIn: XRReferenceSpace | null = null;
  const drawing: DrawingSpace = {
    getReferenceSpace: () => drawnIn ?? (floor as unknown as XRReferenceSpace),
    setReferenceSpace(space) {
      drawnIn = space;
      if (space) spaces.push(space);
    },
  };
  return {
    drawing,
    spaces,
    session: session as unknown as XRSession,
    poseCalls,
    floor: floor as unknown as XRReferenceSpace,
    frame: frame as unknown as XRFrame,
    setHead(at: Seen) {
      head = at;
    },
    setVisibility(state: XRVisibilityState) {
      session.visibilityState = state;
    },
    setInputs(...inputs: Input[]) {
      session.inputSources = inputs;
    },
    /** A source begins or ends its select. */
    select(type: 'selectstart' | 'selectend', inputSource: Input) {
      session.dispatchEvent(Object.assign(new Event(type), { inputSource }));
    },
    /** The device recentres: the room lies elsewhere in the floor's space from now on. */
    reset(roomFromFloor: Place) {
      floor.roomFromSpace = roomFromFloor;
      floor.dispatchEvent(new Event('reset'));
    },
  };
}

/** A fake headset whose session reads one frame after the other, by default 72 a second. */
export function trackedHeadset() {
  const headset = fakeHeadset();
  const pointing = new Pointing(headset.session);
  const tracker = new TrackedSession({ ...headset, pointing });
  let time = 1;
  return {
    ...headset,
    pointing,
    tracker,
    inputs: tracker.inputs,
    read(seconds = 1 / 72) {
      time += seconds;
      return tracker.read(headset.frame, time);
    },
  };
}

/** Column by column, as WebXR writes it. */
function matrixOf({ position, orientation }: Place): readonly number[] {
  const column = (axis: Vec3, last: number) => [axis.x, axis.y, axis.z, last];
  return [
    ...column(rotate(orientation, vec3(1, 0, 0)), 0),
    ...column(rotate(orientation, vec3(0, 1, 0)), 0),
    ...column(rotate(orientation, vec3(0, 0, 1)), 0),
    ...column(position, 1),
  ];
}

export function controller(handedness: Side, at: Seen, trigger = 0): Input {
  return {
    handedness,
    targetRayMode: 'tracked-pointer',
    targetRaySpace: { at },
    profiles: ['meta-quest-touch-plus'],
    gripSpace: { at },
    gamepad: { buttons: [{ value: trigger }, { value: 0 }], axes: [0, 0, 0, 0] },
  };
}

export function bareHand(handedness: Side, at: Seen, gap = 0.08): Input {
  const tip = (offset: number): { at: Seen } => ({
    at: at && { ...at, position: { ...at.position, y: at.position.y + offset } },
  });
  return {
    ...controller(handedness, at),
    profiles: ['oculus-hand', 'generic-hand'],
    hand: new Map([
      ['wrist', { at }],
      ['thumb-tip', tip(0)],
      ['index-finger-tip', tip(gap)],
    ]),
  };
}
