import { reasonOf } from '../core/errors/reasons';
import { bodyFeature } from './device-body-reader';

/** The fault that prevents VR; `reason`: the browser's own message. */
export type XrFault =
  | { readonly kind: 'insecure' | 'no-webxr' | 'no-headset' }
  | { readonly kind: 'refused'; readonly reason: string };

/**
 * The result of asking the browser for VR; `sentence` is the reason for the user. `passthrough`: the headset also shows
 * the room around its user.
 */
export type XrSupport =
  | { readonly kind: 'device'; readonly sentence: null; readonly passthrough: boolean }
  | { readonly kind: 'none'; readonly sentence: string; readonly fault: XrFault };

/** Asks the browser for VR; never rejects. */
export async function describeXrSupport(): Promise<XrSupport> {
  const no = (fault: XrFault, sentence: string): XrSupport => ({ kind: 'none', sentence, fault });
  if (!window.isSecureContext) {
    return no(
      { kind: 'insecure' },
      'VR needs a secure page: open it by https:// or on localhost (docs/running-on-a-headset.md).',
    );
  }
  if (!navigator.xr) return no({ kind: 'no-webxr' }, 'This browser has no WebXR.');
  try {
    const [supported, passthrough] = await Promise.all([
      navigator.xr.isSessionSupported('immersive-vr'),
      isSessionOffered('immersive-ar'),
    ]);
    return supported
      ? { kind: 'device', sentence: null, passthrough }
      : no({ kind: 'no-headset' }, 'No headset is connected to this browser.');
  } catch (error) {
    const reason = reasonOf(error);
    return no({ kind: 'refused', reason }, `WebXR is not allowed here (${reason}).`);
  }
}

/** Returns whether the browser offers sessions of a mode; never rejects. */
export async function isSessionOffered(mode: XRSessionMode): Promise<boolean> {
  // reason: a browser that may not be asked offers none
  return (await navigator.xr?.isSessionSupported(mode).catch(() => false)) ?? false;
}

/** The session features of passthrough: each is optional, and the page works without it. */
const roomFeatures = ['hit-test', 'anchors', 'plane-detection', 'light-estimation'] as const;

/**
 * Requests an immersive session with a floor, with hands where the device tracks them, and with the device's body where
 * `deviceBody` is set and it has one. Rejects with a sentence. Needs a click.
 */
export const requestVrSession = (deviceBody = false): Promise<XRSession> =>
  requestSession('immersive-vr', deviceBody ? [bodyFeature] : []);

/** Requests a session like `requestVrSession` that shows the room around the user in place of a background. */
export const requestPassthroughSession = (deviceBody = false): Promise<XRSession> =>
  requestSession('immersive-ar', [...roomFeatures, ...(deviceBody ? [bodyFeature] : [])]);

/** The session features that every session asks for beside the floor. */
export const usualFeatures = ['hand-tracking', 'bounded-floor', 'layers'] as const;

/** Requests a session with a floor, the usual features and these. Rejects with a sentence. Needs a click. */
export async function requestSession(mode: XRSessionMode, features: readonly string[]): Promise<XRSession> {
  if (!navigator.xr) throw new Error('this browser has no WebXR');
  try {
    return await navigator.xr.requestSession(mode, {
      requiredFeatures: ['local-floor'],
      optionalFeatures: [...usualFeatures, ...features],
    });
  } catch (error) {
    const name = error instanceof DOMException ? error.name : '';
    if (name === 'NotAllowedError' || name === 'SecurityError') throw new Error('the headset refused the session');
    if (name === 'NotSupportedError')
      throw new Error('the headset provides no floor-level reference space (local-floor)');
    throw error;
  }
}

/** The sides [m] of the room within a boundary, along the axes of the floor. */
export interface PlayRoom {
  readonly width: number;
  readonly depth: number;
}

/** Returns the room within the session's boundary; null: the device has none, or does not report it. */
export async function roomOf(session: XRSession): Promise<PlayRoom | null> {
  let space: XRReferenceSpace;
  try {
    space = await session.requestReferenceSpace('bounded-floor');
  } catch {
    // reason: a device without a boundary is a usual one; null says so
    return null;
  }
  const { boundsGeometry = [] } = space as Partial<XRBoundedReferenceSpace>;
  if (boundsGeometry.length < 3) return null;
  const [xs, zs] = [boundsGeometry.map(({ x }) => x), boundsGeometry.map(({ z }) => z)];
  return { width: Math.max(...xs) - Math.min(...xs), depth: Math.max(...zs) - Math.min(...zs) };
}
