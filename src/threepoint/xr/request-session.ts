import { bodyFeature } from './device-body-reader';

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

/** The optional features that every session requests. */
export const defaultFeatures = ['hand-tracking', 'bounded-floor', 'layers'] as const;

/** Requests a session with a floor, the usual features and these. Rejects with a sentence. Needs a click. */
export async function requestSession(mode: XRSessionMode, features: readonly string[]): Promise<XRSession> {
  if (!navigator.xr) throw new Error('this browser has no WebXR');
  try {
    return await navigator.xr.requestSession(mode, {
      requiredFeatures: ['local-floor'],
      optionalFeatures: [...defaultFeatures, ...features],
    });
  } catch (error) {
    const name = error instanceof DOMException ? error.name : '';
    if (name === 'NotAllowedError' || name === 'SecurityError') throw new Error('the headset refused the session');
    if (name === 'NotSupportedError')
      throw new Error('the headset provides no floor-level reference space (local-floor)');
    throw error;
  }
}
