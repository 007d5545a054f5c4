import type { WebGLRenderer } from 'three';
import { bodyFeature, defaultFeatures, drawSession, isSessionOffered, requestSession } from 'threepoint/internal';
import type { HeadsetReport } from './headset-report';

/** The optional features that are requested in addition to the defaults. None of them reveals the user's room. */
const requestedFeatures = [bodyFeature, 'anchors', 'hit-test'] as const;
const modes = ['inline', 'immersive-vr', 'immersive-ar'] as const;

/** Enters a session, which the renderer draws. Call it in a click. Rejects with a sentence. */
export async function enterSession(renderer: WebGLRenderer): Promise<XRSession> {
  const xr = await requestSession('immersive-vr', requestedFeatures);
  return drawSession(xr, renderer.xr, () => xr);
}

/** Collects the features of a session. Input profiles appear with their devices, so every frame is observed. */
export class OfferedFeatures {
  readonly #xr: XRSession;
  readonly #profiles = new Set<string>();

  constructor(xr: XRSession) {
    this.#xr = xr;
  }

  observe(): void {
    for (const { profiles } of this.#xr.inputSources) if (profiles[0]) this.#profiles.add(profiles[0]);
  }

  get profiles(): string[] {
    return [...this.#profiles];
  }

  get ratesHz(): number[] {
    return Array.from(this.#xr.supportedFrameRates ?? []).sort((a, b) => a - b);
  }

  async features(): Promise<HeadsetReport['features']> {
    const offered = await Promise.all(modes.map(isSessionOffered));
    return {
      modes: modes.filter((_, index) => offered[index]),
      asked: ['local-floor', ...defaultFeatures, ...requestedFeatures],
      granted: this.#xr.enabledFeatures ? [...this.#xr.enabledFeatures] : null,
    };
  }
}
