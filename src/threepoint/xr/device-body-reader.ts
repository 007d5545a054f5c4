import { reasonOf } from '../core/errors/reasons';
import { sides } from '../core/math/side';
import { type DeviceBody, deviceBodySize, deviceJointNames, isFiniteDeviceBody } from '../core/tracking/device-body';

/** The session feature of WebXR Body Tracking. */
export const bodyFeature = 'body-tracking';

/** The body of a frame in WebXR Body Tracking: 83 joints by name, 84 on devices that still have a root. */
interface DeviceXRBody {
  get(name: string): XRSpace | undefined;
}

interface BodyFrame {
  readonly body?: DeviceXRBody | null;
  fillPoses?(spaces: readonly XRSpace[], base: XRSpace, transforms: Float32Array): boolean;
  getPose(space: XRSpace, base: XRSpace): XRPose | null | undefined;
}

/**
 * The joints of a Pico headset with motion trackers, 24 as in OpenXR's XR_BD_body_tracking, by the names of WebXR Body
 * Tracking (IsaacTeleop 51). A Pico `left-shoulder` is where the arm begins; WebXR's is the inner end of the clavicle.
 */
const picoNames: Readonly<Record<string, string>> = {
  hips: 'pelvis',
  'spine-lower': 'spine1',
  'spine-middle': 'spine2',
  'spine-upper': 'spine3',
  neck: 'neck',
  head: 'head',
  ...Object.fromEntries(
    sides.flatMap((side) => [
      [`${side}-shoulder`, `${side}-collar`],
      [`${side}-arm-upper`, `${side}-shoulder`],
      [`${side}-arm-lower`, `${side}-elbow`],
      [`${side}-hand-wrist`, `${side}-wrist`],
      [`${side}-hand-palm`, `${side}-hand`],
      [`${side}-upper-leg`, `${side}-hip`],
      [`${side}-lower-leg`, `${side}-knee`],
      [`${side}-foot-ankle`, `${side}-ankle`],
      [`${side}-foot-ball`, `${side}-foot`],
    ]),
  ),
};

/** The joint that takes the place of one that a device with fewer joints lacks. No estimator reads these joints. */
const neighbours: Readonly<Record<string, string>> = {
  chest: 'spine-upper',
  ...Object.fromEntries(
    sides.flatMap((side) => [
      [`${side}-scapula`, `${side}-shoulder`],
      [`${side}-hand-wrist-twist`, `${side}-hand-wrist`],
      [`${side}-foot-ankle-twist`, `${side}-foot-ankle`],
      [`${side}-foot-subtalar`, `${side}-foot-ankle`],
      [`${side}-foot-transverse`, `${side}-foot-ball`],
    ]),
  ),
};

/** The index of each joint's neighbour in `deviceJointNames`; of other joints their own. */
const neighbourOf = deviceJointNames.map((name) => deviceJointNames.indexOf(neighbours[name] ?? name));

/** Returns the space of each joint that the body has, in the order of `deviceJointNames`. */
function spacesOf(body: DeviceXRBody): readonly (XRSpace | undefined)[] {
  const isPico = body.get('pelvis') !== undefined;
  const spaces = deviceJointNames.map((name) => body.get(isPico ? (picoNames[name] ?? name) : name));
  return spaces.map((space, index) => space ?? spaces[neighbourOf[index]!]);
}

/** The size of a matrix, and the index of its translation. */
const matrixSize = 16;
const placeInMatrix = 12;

/**
 * Reads the device's own body frame by frame into one buffer. Never throws: `problem` is a sentence about the fault.
 */
export class DeviceBodyReader {
  readonly #joints: DeviceBody = new Float32Array(deviceBodySize);
  readonly #matrices = new Float32Array(matrixSize * deviceJointNames.length);
  /** The body that `#spaces` belong to; a session has one body. */
  #body: DeviceXRBody | null = null;
  #spaces: readonly XRSpace[] | null = null;
  #fault: string | null = null;
  #seen = false;

  /** The reason why there is no body; null: there is one. */
  get problem(): string | null {
    if (this.#seen) return null;
    if (this.#fault !== null) return this.#fault;
    return this.#body === null ? 'the device reports no body' : 'the device has lost the body, or not found it yet';
  }

  /**
   * Returns the joints [m] in the space, overwritten by the next call; null: not all of them are reported in this
   * frame.
   */
  read(frame: XRFrame, space: XRReferenceSpace): DeviceBody | null {
    try {
      this.#seen = this.#fill(frame as BodyFrame, space);
      // A fault of one frame ends with the next; a missing joint does not.
      if (this.#seen) this.#fault = null;
    } catch (error) {
      this.#seen = false;
      this.#fault = `the device's body cannot be read: ${reasonOf(error)}`;
    }
    return this.#seen ? this.#joints : null;
  }

  #fill(frame: BodyFrame, space: XRReferenceSpace): boolean {
    const body = frame.body ?? null;
    if (body !== this.#body) this.#learn(body);
    if (!this.#spaces) return false;
    return this.#fillAtOnce(frame, space) || this.#fillOneByOne(frame, space);
  }

  #learn(body: DeviceXRBody | null): void {
    this.#body = body;
    this.#spaces = null;
    this.#fault = null;
    if (!body) return;
    const spaces = spacesOf(body);
    const missing = deviceJointNames.filter((_, index) => !spaces[index]);
    if (missing.length > 0) this.#fault = `the device's body has no ${missing.join(', ')}`;
    else this.#spaces = spaces as XRSpace[];
  }

  #fillAtOnce(frame: BodyFrame, space: XRReferenceSpace): boolean {
    if (!frame.fillPoses?.(this.#spaces!, space, this.#matrices)) return false;
    for (let joint = 0; joint < deviceJointNames.length; joint++)
      for (let axis = 0; axis < 3; axis++)
        this.#joints[3 * joint + axis] = this.#matrices[matrixSize * joint + placeInMatrix + axis]!;
    return isFiniteDeviceBody(this.#joints);
  }

  /** Reads joint by joint: the device has no `fillPoses`, or sees some joints only. */
  #fillOneByOne(frame: BodyFrame, space: XRReferenceSpace): boolean {
    for (let joint = 0; joint < deviceJointNames.length; joint++) {
      const neighbour = this.#spaces![neighbourOf[joint]!]!;
      const pose = frame.getPose(this.#spaces![joint]!, space) ?? frame.getPose(neighbour, space);
      if (!pose) return false;
      const { x, y, z } = pose.transform.position;
      this.#joints[3 * joint] = x;
      this.#joints[3 * joint + 1] = y;
      this.#joints[3 * joint + 2] = z;
    }
    return isFiniteDeviceBody(this.#joints);
  }
}
