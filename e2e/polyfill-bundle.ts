import { fileURLToPath } from 'node:url';
import { rolldown } from 'rolldown';

/** Bundles the library's polyfill into one script, which stands for a headset that tracks its user's body. */
export async function bundlePolyfill(): Promise<string> {
  const input = fileURLToPath(new URL('../src/threepoint/api/polyfill.ts', import.meta.url));
  const build = await rolldown({ input, platform: 'browser' });
  const { output } = await build.generate({ format: 'iife', name: 'bodyPolyfill', codeSplitting: false });
  await build.close();
  return output[0].code;
}
