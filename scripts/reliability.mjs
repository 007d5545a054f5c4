// npm run tool -- reliability [--unit | --long | --redraw]: runs the tests that report figures of
// docs/reliability.json, and writes docs/reliability.md. --unit: without a browser. --long: also twenty minutes of play.
// --redraw: writes the page from the last figures.
import { ensureInstalled } from './installation.mjs';
import { main, runProgram } from './run-command.mjs';

await main(async () => {
  await ensureInstalled();
  return runProgram('scripts/reliability/main.ts', process.argv.slice(2));
});
