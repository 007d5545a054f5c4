import type { GripOffsets } from '../core/body/calibration';
import { sideSign } from '../core/body/skeleton';
import type { Frame, Pose } from '../core/math/pose';
import { conjugate, fromAxes, multiply, type Quat, rotate } from '../core/math/quat';
import type { Side } from '../core/math/side';
import { add, cross, scale, subtract, type Vec3, vec3 } from '../core/math/vec3';

/**
 * The fit of a controller in the hand. WebXR's grip: origin in the middle of the fist, −Z along the handle towards the
 * thumb, X through the back of the hand (+X right, −X left). The handle leans from upright (across the palm) towards
 * the fingers.
 */
export interface HandleFit {
  /** The middle of the fist from the wrist [m]: towards the knuckles, and below the back of the hand. */
  readonly ahead: number;
  readonly below: number;
  /** The lean of the handle's thumb end towards the fingers [rad]. */
  readonly lean: number;
}

const degrees = (value: number): number => (value * Math.PI) / 180;

/**
 * The fits by the profile names of the WebXR input profiles registry. The fist is the same for all; the leans are our
 * estimates from the angle between grip and target ray that the runtimes report (Touch: 45°) with the hand pointing
 * along the ray. The registry gives a Galaxy XR controller the parts of a Touch, and has no profile of a PlayStation
 * VR2 Sense, which headsets report as generic: both are held like a Touch. An MX Ink is a pen: thumb and finger hold it
 * before the knuckles, with its tip ahead. No source states its grip, which is our estimate. `GripOffset` corrects any.
 */
const fits: Readonly<Record<string, HandleFit>> = {
  'meta-quest-touch-plus': { ahead: 0.08, below: 0.025, lean: degrees(45) },
  'meta-quest-touch-pro': { ahead: 0.08, below: 0.025, lean: degrees(45) },
  'oculus-touch-v3': { ahead: 0.08, below: 0.025, lean: degrees(45) },
  'oculus-touch-v2': { ahead: 0.08, below: 0.025, lean: degrees(45) },
  'oculus-touch': { ahead: 0.08, below: 0.025, lean: degrees(40) },
  'samsung-galaxyxr': { ahead: 0.08, below: 0.025, lean: degrees(45) },
  'logitech-mx-ink': { ahead: 0.12, below: 0.045, lean: degrees(70) },
  'pico-4': { ahead: 0.08, below: 0.025, lean: degrees(42) },
  'pico-4u': { ahead: 0.08, below: 0.025, lean: degrees(42) },
  'bytedance-pico-4': { ahead: 0.08, below: 0.025, lean: degrees(42) },
  'valve-index': { ahead: 0.085, below: 0.022, lean: degrees(40) },
  'htc-vive': { ahead: 0.085, below: 0.03, lean: degrees(50) },
  'htc-vive-focus-3': { ahead: 0.08, below: 0.025, lean: degrees(45) },
  'microsoft-mixed-reality': { ahead: 0.08, below: 0.028, lean: degrees(35) },
  'windows-mixed-reality': { ahead: 0.08, below: 0.028, lean: degrees(35) },
};

/** The fit of unlisted profiles: most handles follow Touch. */
export const genericFit: HandleFit = { ahead: 0.08, below: 0.025, lean: degrees(45) };

/**
 * The fit of a bare hand, whose grip is where a rod would lie in its fist, straight across the palm: 1 cm and half the
 * thickness of the palm below the middle of the metacarpal bones (webxr-hand-input 114).
 */
export const bareHandFit: HandleFit = { ahead: 0.06, below: 0.02, lean: 0 };

/** The profiles of bare hands: `generic-hand`, `generic-hand-select`, `oculus-hand` and others. */
const bareHandProfile = /(^|-)hand(-|$)/;

/** Returns the name by which offsets are stored: the first known profile of an input source, else its first. */
export const gripDevice = (profiles: readonly string[]): string =>
  profiles.find((profile) => fits[profile]) ?? profiles[0] ?? 'unknown';

/** Returns the fit with the user's offset for this device; the same object without one. */
export function adjustedFit(fit: HandleFit, profiles: readonly string[], offsets: GripOffsets): HandleFit {
  const offset = offsets[gripDevice(profiles)];
  return offset ? { ...fit, ahead: fit.ahead + offset.ahead, lean: fit.lean + offset.lean } : fit;
}

/** Returns the fit of the first known profile of an input source. */
export function handleFit(profiles: readonly string[]): HandleFit {
  for (const profile of profiles) {
    const fit = bareHandProfile.test(profile) ? bareHandFit : fits[profile];
    if (fit) return fit;
  }
  return genericFit;
}

/**
 * A grip in the wrist's frame (threepoint/README.md, Frames): its orientation, the inverse of that, and its origin [m].
 */
interface HeldGrip {
  readonly orientation: Quat;
  readonly inverse: Quat;
  readonly position: Vec3;
}

/** The grips of each fit, computed once. */
const heldGrips = new WeakMap<HandleFit, Readonly<Record<Side, HeldGrip>>>();

function gripInWrist(side: Side, fit: HandleFit): HeldGrip {
  let known = heldGrips.get(fit);
  if (!known) {
    known = { left: holdGrip('left', fit), right: holdGrip('right', fit) };
    heldGrips.set(fit, known);
  }
  return known[side];
}

function holdGrip(side: Side, { ahead, below, lean }: HandleFit): HeldGrip {
  const sigma = sideSign(side);
  const thumb = vec3(-sigma, 0, 0);
  const back = vec3(0, 1, 0);
  const knuckles = vec3(0, 0, -1);
  const handle = add(scale(thumb, Math.cos(lean)), scale(knuckles, Math.sin(lean)));
  const x = scale(back, sigma);
  const z = scale(handle, -1);
  const orientation = fromAxes(x, cross(z, x), z);
  return { orientation, inverse: conjugate(orientation), position: vec3(0, -below, -ahead) };
}

/** Returns the wrist of a hand that holds a controller by this grip, in the grip's space. */
export function wristFromGrip<F extends Frame>(grip: Pose<F>, side: Side, fit: HandleFit): Pose<F> {
  const held = gripInWrist(side, fit);
  const orientation = multiply(grip.orientation, held.inverse);
  const position = rotate(orientation, held.position);
  return { orientation, position: subtract(grip.position, position, position) };
}

/** Returns a controller's grip in a hand with this wrist: the inverse of `wristFromGrip`. */
export function gripFromWrist<F extends Frame>(wrist: Pose<F>, side: Side, fit: HandleFit): Pose<F> {
  const held = gripInWrist(side, fit);
  const position = rotate(wrist.orientation, held.position);
  return {
    orientation: multiply(wrist.orientation, held.orientation),
    position: add(wrist.position, position, position),
  };
}
