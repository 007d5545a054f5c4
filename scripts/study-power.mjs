// npm run study:power -- --effect 0.5 [--design paired|between] [--power 0.8] [--alpha 0.05] [--studies 10000] [--seed
// 1]: prints how many participants a study needs.
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, runProgram, SetupError } from './run-command.mjs';

const usage =
  'npm run study:power -- --effect 0.5 [--design paired|between] [--power 0.8] [--alpha 0.05] [--studies 10000] [--seed 1]';

function options() {
  const text = { type: 'string' };
  try {
    const { values } = parseArgs({
      options: { effect: text, design: text, power: text, alpha: text, studies: text, seed: text },
    });
    return values;
  } catch (error) {
    throw new SetupError(`study:power: ${error.message}\n${usage}`);
  }
}

await main(async () => {
  const given = options();
  await ensureInstalled();
  return runProgram('src/study/cli/power/main.ts', [JSON.stringify(given)]);
});
