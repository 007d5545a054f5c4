// npm run renew -- --mocap DIR [--from STEP] [--only STEP] [--list]: renews the networks, and every table and figure of
// docs/accuracy.md, in the steps of renew-steps.mjs.
import { readOptions } from './command-line.mjs';
import { chosenSteps, commandLine, commandLineOf, commandOf } from './renew-steps.mjs';
import { main, run, typedPath } from './run-command.mjs';

const usage =
  'npm run renew -- --mocap DIR [--from STEP] [--only STEP]\n' +
  'npm run renew -- --list [--from STEP] [--only STEP]\n' +
  'DIR holds the .asf and .amc or .bvh files of everyone; STEP is one of those that --list names.';
const oneDay = 24 * 3600;

function options() {
  return readOptions('renew', usage, { texts: ['mocap', 'from', 'only'], flags: ['list'] }, ({ mocap, list }) => {
    if (!mocap && !list) throw new Error('--mocap is needed');
  });
}

/** Formats seconds as 1:02:03. */
function duration(milliseconds) {
  const seconds = Math.round(milliseconds / 1000);
  const two = (value) => `${value}`.padStart(2, '0');
  return `${Math.floor(seconds / 3600)}:${two(Math.floor(seconds / 60) % 60)}:${two(seconds % 60)}`;
}

function list(chosen, mocap) {
  for (const step of chosen)
    console.log(`${step.name}: ${step.renews}; about ${step.takes}\n  ${commandLineOf(step, mocap)}`);
  return 0;
}

await main(async () => {
  const { mocap = 'DIR', ...given } = options();
  const chosen = chosenSteps(given);
  if (given.list) return list(chosen, mocap);
  const folder = typedPath(mocap);
  for (const [number, step] of chosen.entries()) {
    const title = `renew ${number + 1} of ${chosen.length}, ${step.name}`;
    console.log(`\n${title}: ${step.renews}; about ${step.takes}\n${commandLineOf(step, folder)}`);
    const start = performance.now();
    const { code } = await run(process.execPath, commandOf(step, folder), { limitSeconds: oneDay });
    const took = duration(performance.now() - start);
    if (code !== 0) {
      const again = commandLine('renew', '--mocap', mocap, given.only ? '--only' : '--from', step.name);
      console.error(
        `\nrenew: the step ${step.name} ended with exit code ${code} after ${took}; its messages are above. Once that is mended, go on with\n  ${again}`,
      );
      return code;
    }
    console.log(`${title}: took ${took}`);
  }
  return 0;
});
