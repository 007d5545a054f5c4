import { reasonOf } from '../core/errors/reasons';
import { gltfFaults } from './validate-gltf';

/** What comes back for a file: its faults, or why it could not be looked at. */
export type ValidatorAnswer = { readonly faults: readonly string[] } | { readonly broken: string };

self.addEventListener('message', ({ data: bytes }: MessageEvent<Uint8Array>) => {
  gltfFaults(bytes).then(
    (faults) => self.postMessage({ faults } satisfies ValidatorAnswer),
    (error: unknown) => self.postMessage({ broken: reasonOf(error) } satisfies ValidatorAnswer),
  );
});
