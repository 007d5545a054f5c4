import { reasonOf } from '../core/errors/reasons';

/** The fault that prevents VR; `reason`: the browser's own message. */
export type XrFault =
  | { readonly kind: 'insecure' | 'no-webxr' | 'no-headset' }
  | { readonly kind: 'refused'; readonly reason: string };

/**
 * The result of asking the browser for VR; `sentence` is the reason for the user. `passthrough`: the headset also shows
 * the room around its user.
 */
type XrSupport =
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
