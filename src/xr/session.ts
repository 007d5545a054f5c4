import { reasonOf } from '../core/errors/reasons';
import { bodyFeature } from './device-body-reader';

/** What the browser offers; `sentence` tells the user why not, or null. */
export interface XrSupport {
  readonly kind: 'device' | 'none';
  readonly sentence: string | null;
}

/** Asks the browser once; never rejects. */
export async function describeXrSupport(): Promise<XrSupport> {
  const no = (sentence: string): XrSupport => ({ kind: 'none', sentence });
  if (!window.isSecureContext) {
    return no('VR needs a secure page: open it by https:// or on localhost (docs/running-on-a-headset.md).');
  }
  if (!navigator.xr) return no('This browser has no WebXR.');
  try {
    const supported = await navigator.xr.isSessionSupported('immersive-vr');
    return supported ? { kind: 'device', sentence: null } : no('No headset is connected to this browser.');
  } catch (error) {
    return no(`WebXR is not allowed here (${reasonOf(error)}).`);
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
