// npm run tool -- reliability [--unit | --long | --redraw]: runs the tests of every row of tests/reliability/rows.ts
// and writes their figures to docs/reliability.md. --unit: without a browser. --long: also twenty minutes of play.
// --redraw: writes the page from the last figures.
import { buildWhenStale } from './build.mjs';
import { ensureChromium } from './chromium.mjs';
import { ensureInstalled } from './installation.mjs';
import { main, runProgram } from './run-command.mjs';

await main(async () => {
  const options = process.argv.slice(2);
  await ensureInstalled();
  if (!options.includes('--unit') && !options.includes('--redraw')) {
    process.env.CHROMIUM_PATH = await ensureChromium();
    await buildWhenStale();
  }
  return runProgram('scripts/reliability/main.ts', options);
});
