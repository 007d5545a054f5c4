import { buildWhenStale } from '../scripts/build.mjs';
import { ensureChromium } from '../scripts/chromium.mjs';

/** Builds the page if a source changed, and finds or installs the browser. Workers inherit its path. */
export default async function prepare(): Promise<void> {
  process.env.CHROMIUM_PATH = await ensureChromium();
  await buildWhenStale();
}
