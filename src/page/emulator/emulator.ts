import type { XRDevice, XRDeviceConfig } from 'iwer';
import { allReleased, type Buttons, type TrackingFrame } from 'threepoint/core';
import { endSession } from 'threepoint/internal';
import {
  composeTransforms,
  fromAxes,
  invertTransform,
  type Pose,
  type Side,
  sides,
  type TrackedPose,
  vec3,
} from 'threepoint/math';
import { gripFromWrist, type HandleFit, handleFit, wristFromGrip } from 'threepoint/webxr';
import { closeOnEscape } from 'threepoint-ui';

/** The initial head and hands of a person of 1.70 m, who sees both hands [m]. */
const rest = { head: vec3(0, 1.59, 0), left: vec3(-0.22, 1.32, -0.45), right: vec3(0.22, 1.32, -0.45) };

/**
 * Installs iwer in place of the browser's own WebXR. The code of the emulator is loaded here and nowhere else, so that
 * real headsets never pay for it.
 */
export async function installEmulator(): Promise<Emulator> {
  const { XRDevice: Device, XRReferenceSpace: ReferenceSpace, metaQuest3 } = await import('iwer');
  fixOffsetSpaces(ReferenceSpace.prototype);
  const device = new Device(metaQuest3, { stereoEnabled: false });
  const { userAgent } = navigator;
  device.installRuntime({ forceInstall: true });
  // iwer sets that of its headset. Reports and studies name the browser that ran them.
  Object.defineProperty(navigator, 'userAgent', { value: userAgent, configurable: true });
  markAsTracked(device);
  return new Emulator(device, metaQuest3.controllerConfig);
}

/** An emulated headset, for browsers without a device. */
export class Emulator {
  readonly device: XRDevice;
  readonly #config: ControllerConfig;
  readonly #fit: HandleFit;
  #controls: Promise<void> | null = null;
  #panelVisible = false;

  constructor(device: XRDevice, config: ControllerConfig) {
    this.device = device;
    this.#config = config;
    this.#fit = handleFit(config ? [config.profileId, ...config.fallbackProfileIds] : []);
    device.position.set(rest.head.x, rest.head.y, rest.head.z);
    for (const side of sides) {
      const { x, y, z } = rest[side];
      device.controllers[side]?.position.set(x, y, z);
    }
  }

  /** Returns the current head and wrists of the emulator. It needs no session. */
  read(time: number): TrackingFrame {
    return {
      time,
      head: { ...copyPlace(this.device), tracking: 'tracked' },
      leftHand: this.#readHand('left'),
      rightHand: this.#readHand('right'),
    };
  }

  /** Moves headset and controllers to the head and wrists of a frame, to within 0.1 mm, and presses these buttons. */
  drive(frame: TrackingFrame, buttons?: Buttons): void {
    // In the manual mode the controls would reset every pose in each frame.
    this.#setControlMode('programmatic');
    place(this.device, frame.head);
    for (const side of sides) {
      const wrist = side === 'left' ? frame.leftHand : frame.rightHand;
      const controller = this.device.controllers[side];
      if (!controller) continue;
      controller.connected = wrist !== null;
      const { trigger, grip: squeeze } = buttons?.[side] ?? allReleased;
      controller.updateButtonValue('trigger', trigger);
      controller.updateButtonValue('squeeze', squeeze);
      if (!wrist) continue;
      const grip = gripFromWrist<'floor'>(wrist, side, this.#fit);
      const rayInGrip = invertTransform<'floor', 'floor'>(this.#gripInRay(side));
      place(controller, composeTransforms<'floor', 'floor', 'floor'>(grip, rayInGrip));
    }
  }

  /** Lets Esc end a session of this emulator. */
  endOnEscape(session: XRSession): void {
    session.addEventListener(
      'end',
      closeOnEscape(() => void endSession(session)),
    );
  }

  /** Lets mouse and keys move headset and controllers again. */
  release(): void {
    this.#setControlMode('manual');
  }

  /**
   * Loads the controls by mouse and keys: arrows at the hands, and the developer's panel. iwer shows them when a
   * session begins; controls that are installed during one fail at its end.
   */
  async loadControls(): Promise<void> {
    this.#controls ??= import('@iwer/devui').then(({ DevUI }) => this.device.installDevUI(DevUI));
    await this.#controls;
    this.#showPanel();
  }

  /** Shows or hides the developer's panel while mouse and keys move the headset. */
  setPanelVisible(visible: boolean): void {
    this.#panelVisible = visible;
    this.#showPanel();
  }

  /** Lets the mouse turn the head, and keys walk, until Esc. Call it when a button is pressed. */
  lookAround(): void {
    void this.device.devui?.devUICanvas.requestPointerLock();
  }

  #setControlMode(mode: XRDevice['controlMode']): void {
    if (this.device.controlMode === mode) return;
    this.device.controlMode = mode;
    this.#showPanel();
  }

  /** In the programmatic mode the panel is a glowing frame and a notice for developers. */
  #showPanel(): void {
    const container = this.device.devui?.devUIContainer;
    if (container) container.hidden = !this.#panelVisible || this.device.controlMode === 'programmatic';
  }

  #readHand(side: Side): TrackedPose | null {
    const controller = this.device.controllers[side];
    if (!controller?.connected) return null;
    const grip = composeTransforms<'floor', 'floor', 'floor'>(copyPlace(controller), this.#gripInRay(side));
    return { ...wristFromGrip<'floor'>(grip, side, this.#fit), tracking: 'tracked' };
  }

  /** Returns the grip relative to the target ray: iwer places controllers by their target ray. */
  #gripInRay(side: Side): Pose<'floor'> {
    return matrixPose(this.#config?.layout[side]?.gripOffsetMatrix);
  }
}

const copyPlace = ({ position: p, quaternion: q }: Placed): Pose<'floor'> => ({
  position: vec3(p.x, p.y, p.z),
  orientation: { x: q.x, y: q.y, z: q.z, w: q.w },
});

function place(target: { readonly position: Setter3; readonly quaternion: Setter4 }, pose: Pose<'floor'>): void {
  const { position: p, orientation: o } = pose;
  target.position.set(p.x, p.y, p.z);
  target.quaternion.set(o.x, o.y, o.z, o.w);
}

/** The part of iwer's reference spaces that is fixed here. */
interface OffsetSpaces {
  getOffsetReferenceSpace(origin: unknown): unknown;
}

/** Passes the matrix of an offset to iwer, which uses the transform itself as a matrix: every pose would be NaN. */
function fixOffsetSpaces(spaces: OffsetSpaces): void {
  const { getOffsetReferenceSpace } = spaces;
  spaces.getOffsetReferenceSpace = function (this: OffsetSpaces, origin) {
    return getOffsetReferenceSpace.call(this, (origin as XRRigidTransform).matrix);
  };
}

/**
 * Marks the controllers as tracked. By default iwer reports every position as emulated (`emulatedPosition`), behind a
 * symbol.
 */
function markAsTracked(device: XRDevice): void {
  const inputs = [...Object.values(device.controllers), ...Object.values(device.hands)];
  const spaces: (object | undefined)[] = [device.viewerSpace, ...Object.values(device.viewSpaces)];
  for (const input of inputs) {
    if (!input) continue;
    const { inputSource } = input;
    spaces.push(inputSource.targetRaySpace, inputSource.gripSpace, ...(inputSource.hand?.values() ?? []));
  }
  for (const space of spaces) {
    if (!space) continue;
    const key = Object.getOwnPropertySymbols(space).find(({ description }) => description === '@iwer/xr-space');
    if (!key) throw new Error('iwer: expected a space to keep its state under the symbol @iwer/xr-space');
    (space as Record<symbol, { emulated: boolean }>)[key]!.emulated = false;
  }
}

/** The controllers of a headset in iwer's configuration; undefined: it has none. */
type ControllerConfig = XRDeviceConfig['controllerConfig'];

/** An object that iwer places in the room. */
interface Placed {
  readonly position: { readonly x: number; readonly y: number; readonly z: number };
  readonly quaternion: { readonly x: number; readonly y: number; readonly z: number; readonly w: number };
}

interface Setter3 {
  set(x: number, y: number, z: number): unknown;
}
interface Setter4 {
  set(x: number, y: number, z: number, w: number): unknown;
}

/** Returns the pose of a column-major 4×4 matrix; the identity without a matrix. */
function matrixPose(matrix: ArrayLike<number> | undefined): Pose<'floor'> {
  const at = (index: number): number => matrix?.[index] ?? (index % 5 === 0 ? 1 : 0);
  return {
    orientation: fromAxes(vec3(at(0), at(1), at(2)), vec3(at(4), at(5), at(6)), vec3(at(8), at(9), at(10))),
    position: vec3(at(12), at(13), at(14)),
  };
}
