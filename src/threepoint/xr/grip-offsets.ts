import { type GripOffsets, type HandleFit, handleFitParts } from '../core/body/calibration';
import { sideSign } from '../core/body/skeleton';
import type { Frame, Pose } from '../core/math/pose';
import { conjugate, fromAxes, fromAxisAngle, multiply, type Quat, rotate } from '../core/math/quat';
import type { Side } from '../core/math/side';
import { add, subtract, type Vec3, vec3 } from '../core/math/vec3';

/** Returns the fit of a handle in a level hand. `lean`: [degrees]. */
const held = (ahead: number, below: number, lean: number): HandleFit => ({
  ...{ ahead, below, thumbward: 0 },
  ...{ lean: (lean * Math.PI) / 180, pitch: 0, roll: 0 },
});

/**
 * The fits by the profile names of the WebXR input profiles registry. The fist is the same for all; the leans are our
 * estimates from the angle between grip and target ray that the runtimes report (Touch: 45°) with the hand pointing
 * along the ray. None is measured on people. The registry gives a Galaxy XR controller the parts of a Touch, and has no
 * profile of a PlayStation VR2 Sense: both are held like a Touch. An MX Ink is a pen: thumb and finger hold it
 * before the knuckles, with its tip ahead. No source states its grip, which is our estimate. `GripOffset` corrects any.
 */
const fits: Readonly<Record<string, HandleFit>> = {
  'meta-quest-touch-plus': held(0.08, 0.025, 45),
  'meta-quest-touch-pro': held(0.08, 0.025, 45),
  'oculus-touch-v3': held(0.08, 0.025, 45),
  'oculus-touch-v2': held(0.08, 0.025, 45),
  'oculus-touch': held(0.08, 0.025, 40),
  'samsung-galaxyxr': held(0.08, 0.025, 45),
  'logitech-mx-ink': held(0.12, 0.045, 70),
  'pico-4': held(0.08, 0.025, 42),
  'pico-4u': held(0.08, 0.025, 42),
  'bytedance-pico-4': held(0.08, 0.025, 42),
  'valve-index': held(0.085, 0.022, 40),
  'htc-vive': held(0.085, 0.03, 50),
  'htc-vive-focus-3': held(0.08, 0.025, 45),
  'microsoft-mixed-reality': held(0.08, 0.028, 35),
  'windows-mixed-reality': held(0.08, 0.028, 35),
};

/** The fit of unlisted profiles: most handles follow Touch. */
export const genericFit: HandleFit = held(0.08, 0.025, 45);

/**
 * The fit of a bare hand, whose grip is where a rod would lie in its fist, straight across the palm: 1 cm and half the
 * thickness of the palm below the middle of the metacarpal bones (webxr-hand-input 114).
 */
export const bareHandFit: HandleFit = held(0.06, 0.02, 0);

/** The profiles of bare hands: `generic-hand`, `generic-hand-select`, `oculus-hand` and others. */
const bareHandProfile = /(^|-)hand(-|$)/;

/** Returns the name by which offsets are stored: the first known profile of an input source, else its first. */
export const gripDevice = (profiles: readonly string[]): string =>
  profiles.find((profile) => fits[profile]) ?? profiles[0] ?? 'unknown';

/** Returns the fit with the user's offset for this device in this hand; the same object without one. */
export function adjustedFit(fit: HandleFit, profiles: readonly string[], side: Side, offsets: GripOffsets): HandleFit {
  const offset = offsets[gripDevice(profiles)]?.[side];
  if (!offset) return fit;
  const adjusted = { ...fit };
  for (const part of handleFitParts) adjusted[part] += offset[part] ?? 0;
  return adjusted;
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

/**
 * WebXR's grip has its origin in the middle of the fist, −Z along the handle towards the thumb, and X through the back
 * of the hand (+X right, −X left).
 */
function holdGrip(side: Side, { ahead, below, thumbward, lean, pitch, roll }: HandleFit): HeldGrip {
  const sigma = sideSign(side);
  const acrossPalm = fromAxes(vec3(0, sigma, 0), vec3(0, 0, 1), vec3(sigma, 0, 0));
  const pitched = fromAxisAngle(vec3(1, 0, 0), pitch);
  const rolled = multiply(pitched, fromAxisAngle(vec3(0, 0, 1), -sigma * roll));
  const leaning = multiply(rolled, fromAxisAngle(vec3(0, 1, 0), -sigma * lean));
  const orientation = multiply(leaning, acrossPalm);
  return { orientation, inverse: conjugate(orientation), position: vec3(-sigma * thumbward, -below, -ahead) };
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
