import type { Page } from '@playwright/test';

export type Point = readonly [x: number, y: number, z: number];
export type Rotation = readonly [x: number, y: number, z: number, w: number];
export type Side = 'left' | 'right';

/** A position [m] and orientation in the floor frame, as plain numbers that can be passed into the page. */
export interface PlacedPose {
  readonly position: Point;
  readonly orientation: Rotation;
}

/**
 * The poses to set on the emulated devices. A hand is placed by its target ray, as in iwer; absent poses are unchanged.
 */
export interface Placement {
  readonly head?: Partial<PlacedPose>;
  readonly left?: Partial<PlacedPose>;
  readonly right?: Partial<PlacedPose>;
}

/** The part of iwer's device that tests control; iwer stores it under a symbol. */
interface Device {
  position: { set(...xyz: Point): void };
  quaternion: { set(...xyzw: Rotation): void };
  primaryInputMode: 'controller' | 'hand';
  controlMode: 'manual' | 'programmatic';
  readonly controllers: Record<Side, TrackedInput>;
  readonly hands: Record<Side, TrackedInput>;
  recenter(): void;
  updateVisibilityState(state: 'visible' | 'visible-blurred' | 'hidden'): void;
  readonly activeSession?: XRSession;
}

interface TrackedInput {
  position: { set(...xyz: Point): void; readonly x: number; readonly y: number; readonly z: number };
  quaternion: { set(...xyzw: Rotation): void };
  connected: boolean;
  updateTargetRaySpace(): void;
  /** Sets how far a controller's button is pressed, 0 to 1. */
  updateButtonValue(id: 'trigger' | 'squeeze', value: number): void;
  /** Sets how far a tracked hand pinches, 0 to 1. */
  updatePinchValue(value: number): void;
  readonly inputSource: {
    readonly targetRaySpace: object;
    readonly gripSpace: object;
    readonly hand?: Map<string, object>;
  };
}

declare global {
  interface Window {
    /** Set by `reachDevice` in this file: the emulator that iwer stores in navigator.xr. */
    emulatedDevice: Device;
  }
}

/** Finds the emulator that iwer stores in navigator.xr under a symbol, and stores it for the other functions here. */
async function reachDevice(page: Page): Promise<void> {
  await page.waitForFunction(() => {
    const system = navigator.xr as unknown as Record<symbol, { device: Window['emulatedDevice'] }> | undefined;
    const key = Object.getOwnPropertySymbols(system ?? {}).find(({ description }) => description === '@iwer/xr-system');
    const kept = key && system?.[key];
    if (kept) window.emulatedDevice = kept.device;
    return Boolean(kept);
  });
}

/** Resolves after this number of animation frames of the page. */
export async function frames(page: Page, count: number): Promise<void> {
  await page.evaluate(
    (left) =>
      new Promise<void>((resolve) => {
        const next = () => (left-- > 0 ? requestAnimationFrame(next) : resolve());
        next();
      }),
    count,
  );
}

/** Controls the emulated headset of a page. */
export interface EmulatedHeadset {
  place(placement: Placement): Promise<void>;
  setConnected(side: Side, connected: boolean): Promise<void>;
  useInput(mode: 'controller' | 'hand'): Promise<void>;
  /** Sets how far a tracked hand pinches, 0 to 1. */
  pinch(side: Side, closed: number): Promise<void>;
  /** Sets how far a controller's trigger is pressed, 0 to 1. */
  pull(side: Side, pressed: number): Promise<void>;
  recentre(): Promise<void>;
  setVisibility(state: 'visible' | 'visible-blurred' | 'hidden'): Promise<void>;
  endSession(): Promise<void>;
  /** Returns the pose of the controller's grip in the floor frame as WebXR reports it, from iwer's own matrices. */
  grip(side: Side): Promise<PlacedPose>;
  /** Returns the pose of the tracked hand's wrist joint in the floor frame. */
  wristJoint(side: Side): Promise<PlacedPose>;
}

/** Returns the controls of the page's emulator; waits until the page has installed it. */
export async function emulatedHeadset(page: Page): Promise<EmulatedHeadset> {
  await reachDevice(page);

  const place = (placement: Placement) =>
    page.evaluate((wanted) => {
      const device = window.emulatedDevice;
      // Otherwise the emulator's own panel resets head and hands to its own poses in every frame.
      device.controlMode = 'programmatic';
      const put = (
        target: { position: { set(...xyz: Point): void }; quaternion: { set(...xyzw: Rotation): void } },
        pose: Partial<PlacedPose> | undefined,
      ) => {
        if (pose?.position) target.position.set(...pose.position);
        if (pose?.orientation) target.quaternion.set(...pose.orientation);
      };
      put(device, wanted.head);
      for (const side of ['left', 'right'] as const) {
        put(device.controllers[side], wanted[side]);
        put(device.hands[side], wanted[side]);
      }
    }, placement);

  /** Returns the pose of a space of an input: the product of iwer's column-major 4×4 matrices up to the floor. */
  const spacePose = (side: Side, name: 'gripSpace' | 'wrist'): Promise<PlacedPose> =>
    page.evaluate(
      ([side, name]) => {
        type Space = { offsetMatrix: ArrayLike<number>; parentSpace?: object };
        const { controllers, hands } = window.emulatedDevice;
        const input = (name === 'wrist' ? hands : controllers)[side];
        // A session does this in every frame; without a session it has to be done here.
        input.updateTargetRaySpace();
        const source = input.inputSource;
        const own = (space: object) => {
          const key = Object.getOwnPropertySymbols(space).find(({ description }) => description === '@iwer/xr-space');
          if (!key) throw new Error('this iwer keeps its spaces differently: expected the symbol @iwer/xr-space');
          return (space as Record<symbol, Space>)[key] as Space;
        };
        let matrix = new DOMMatrix();
        const wrist = source.hand?.get('wrist');
        for (
          let space: object | undefined = name === 'wrist' ? wrist : source.gripSpace;
          space;
          space = own(space).parentSpace
        ) {
          matrix = new DOMMatrix(Array.from(own(space).offsetMatrix)).multiply(matrix);
        }
        const m = matrix;
        // The largest of the four components comes first: the others follow from it without cancellation.
        const squares = [
          1 + m.m11 - m.m22 - m.m33,
          1 - m.m11 + m.m22 - m.m33,
          1 - m.m11 - m.m22 + m.m33,
          1 + m.m11 + m.m22 + m.m33,
        ];
        const largest = squares.indexOf(Math.max(...squares));
        const s = 2 * Math.sqrt(squares[largest] as number);
        const xy = (m.m12 + m.m21) / s;
        const xz = (m.m13 + m.m31) / s;
        const yz = (m.m23 + m.m32) / s;
        const [wx, wy, wz] = [(m.m23 - m.m32) / s, (m.m31 - m.m13) / s, (m.m12 - m.m21) / s];
        const orientations = [
          [s / 4, xy, xz, wx],
          [xy, s / 4, yz, wy],
          [xz, yz, s / 4, wz],
          [wx, wy, wz, s / 4],
        ] as const;
        return { position: [m.m41, m.m42, m.m43] as const, orientation: orientations[largest] as Rotation };
      },
      [side, name] as const,
    );

  return {
    place,
    setConnected: (side, connected) =>
      page.evaluate(
        ([side, connected]) => {
          window.emulatedDevice.controllers[side].connected = connected;
          window.emulatedDevice.hands[side].connected = connected;
        },
        [side, connected] as const,
      ),
    useInput: (mode) =>
      page.evaluate((mode) => {
        window.emulatedDevice.primaryInputMode = mode;
      }, mode),
    pinch: (side, closed) =>
      page.evaluate(([side, closed]) => window.emulatedDevice.hands[side].updatePinchValue(closed), [
        side,
        closed,
      ] as const),
    pull: (side, pressed) =>
      page.evaluate(
        ([side, pressed]) => window.emulatedDevice.controllers[side].updateButtonValue('trigger', pressed),
        [side, pressed] as const,
      ),
    recentre: () => page.evaluate(() => window.emulatedDevice.recenter()),
    setVisibility: (state) => page.evaluate((state) => window.emulatedDevice.updateVisibilityState(state), state),
    endSession: () => page.evaluate(() => window.emulatedDevice.activeSession?.end()),
    grip: (side) => spacePose(side, 'gripSpace'),
    wristJoint: (side) => spacePose(side, 'wrist'),
  };
}
