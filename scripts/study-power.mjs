// npm run study:power -- --effect 0.5 [--design paired|between] [--power 0.8] [--alpha 0.05] [--studies 10000] [--seed
// 1]: prints how many participants a study needs.
import { readOptions, runAsScript } from './command-line.mjs';

const usage =
  'npm run study:power -- --effect 0.5 [--design paired|between] [--power 0.8] [--alpha 0.05] [--studies 10000] [--seed 1]';
const texts = ['effect', 'design', 'power', 'alpha', 'studies', 'seed'];

await runAsScript('src/study/cli/power/main.ts', () => {
  const { rest: _, ...given } = readOptions('study:power', usage, { texts });
  return [JSON.stringify(given)];
});
