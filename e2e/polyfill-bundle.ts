import { fileURLToPath } from 'node:url';
import { rolldown } from 'rolldown';

/** Bundles a module of the repository, with what it imports, into one script. `name`: of its exports in the page. */
export async function bundle(path: string, name: string): Promise<string> {
  const input = fileURLToPath(new URL(`../${path}`, import.meta.url));
  const build = await rolldown({ input, platform: 'browser' });
  const { output } = await build.generate({ format: 'iife', name, codeSplitting: false });
  await build.close();
  return output[0].code;
}

/** Bundles the library's polyfill, which stands for a headset that tracks its user's body. */
export const bundlePolyfill = (): Promise<string> => bundle('src/threepoint/api/polyfill.ts', 'bodyPolyfill');
