import { reasonOf } from '../core/errors/reasons';
import { bodyFeature } from './device-body-reader';

/** Why no headset can be worn; `reason`: as the browser says it. */
export type XrFault =
  | { readonly kind: 'insecure' | 'no-webxr' | 'no-headset' }
  | { readonly kind: 'refused'; readonly reason: string };

/** What the browser offers; `sentence` tells the user why not. */
export type XrSupport =
  | { readonly kind: 'device'; readonly sentence: null }
  | { readonly kind: 'none'; readonly sentence: string; readonly fault: XrFault };

/** Asks the browser once; never rejects. */
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
    const supported = await navigator.xr.isSessionSupported('immersive-vr');
    return supported
      ? { kind: 'device', sentence: null }
      : no({ kind: 'no-headset' }, 'No headset is connected to this browser.');
  } catch (error) {
    const reason = reasonOf(error);
    return no({ kind: 'refused', reason }, `WebXR is not allowed here (${reason}).`);
  }
}

/**
 * Starts an immersive session on the floor, with hands where the device tracks them, and with its own body where that is wanted and the device has
 * one. Rejects with a sentence. Needs a click.
 */
export async function requestVrSession(deviceBody = false): Promise<XRSession> {
  if (!navigator.xr) throw new Error('this browser has no WebXR');
  try {
    return await navigator.xr.requestSession('immersive-vr', {
      requiredFeatures: ['local-floor'],
      optionalFeatures: ['hand-tracking', 'bounded-floor', 'layers', ...(deviceBody ? [bodyFeature] : [])],
    });
  } catch (error) {
    const name = error instanceof DOMException ? error.name : '';
    if (name === 'NotAllowedError' || name === 'SecurityError') throw new Error('the headset refused the session');
    if (name === 'NotSupportedError') throw new Error('the headset offers no floor to stand on (local-floor)');
    throw error;
  }
}

/** Sides [m] of what a boundary leaves, along the axes of the floor. */
export interface PlayRoom {
  readonly width: number;
  readonly depth: number;
}

/** The room of the session's boundary; null: the device has none, or does not tell. */
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
