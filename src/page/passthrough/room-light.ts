import { rotate } from 'threepoint/math';
import type { EstimatedLight } from '../scene/surroundings';

/** WebXR's light estimation, which the types leave out in part. */
interface LightProbe {
  readonly probeSpace: XRSpace;
}
interface LightEstimate {
  readonly primaryLightDirection: { readonly x: number; readonly y: number; readonly z: number };
  readonly primaryLightIntensity: { readonly x: number; readonly y: number; readonly z: number };
  readonly sphericalHarmonicsCoefficients: ArrayLike<number>;
}
interface EstimatingSession {
  requestLightProbe?(): Promise<LightProbe>;
}
interface EstimatingFrame {
  getLightEstimate?(probe: LightProbe): LightEstimate | null;
}

/** The largest light intensity; a brighter light would overexpose the avatar. */
const brightest = 1.5;
/** The irradiance of the constant term of spherical harmonics: the square root of π, halved. */
const constantTerm = Math.sqrt(Math.PI) / 2;

const clamped = (value: number): number => (value > 0 ? Math.min(value, brightest) : 0);

/** Reads the device's estimate of the room's light. */
export class RoomLight {
  #probe: LightProbe | null = null;

  /** Never rejects: a session without the feature has no probe. */
  async start(session: XRSession): Promise<void> {
    const { requestLightProbe } = session as EstimatingSession;
    // reason: browsers reject where the device or the user does not grant the feature, which is optional
    this.#probe = (await requestLightProbe?.call(session).catch(() => null)) ?? null;
  }

  /** Returns the estimate of a frame; null: the device has none. */
  read(frame: XRFrame, floorSpace: XRReferenceSpace): EstimatedLight | null {
    const probe = this.#probe;
    const estimate = probe && (frame as EstimatingFrame).getLightEstimate?.(probe);
    const pose = probe && frame.getPose(probe.probeSpace, floorSpace);
    if (!estimate || !pose) return null;
    const { x, y, z } = estimate.primaryLightDirection;
    const length = Math.hypot(x, y, z);
    if (!(length > 0)) return null;
    const from = rotate(pose.transform.orientation, { x: x / length, y: y / length, z: z / length });
    const { x: red, y: green, z: blue } = estimate.primaryLightIntensity;
    const { 0: r = 0, 1: g = 0, 2: b = 0 } = estimate.sphericalHarmonicsCoefficients;
    return {
      from: [from.x, from.y, from.z],
      key: [clamped(red), clamped(green), clamped(blue)],
      fill: [clamped(constantTerm * r), clamped(constantTerm * g), clamped(constantTerm * b)],
    };
  }
}
