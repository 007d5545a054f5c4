// npm run study:check -- PLAN.json [--participant P01]: prints the errors of a plan, or its duration and what its
// participants see.
import { readOptions, runAsScript } from './command-line.mjs';
import { typedPath } from './run-command.mjs';

const usage = 'npm run study:check -- PLAN.json [--participant P01]';

await runAsScript('src/study/cli/check/main.ts', () => {
  const { rest, participant } = readOptions(
    'study:check',
    usage,
    { texts: ['participant'], rest: true },
    ({ rest }) => {
      if (rest.length !== 1) throw new Error(`one plan is needed, not ${rest.length}`);
    },
  );
  return [...rest.map(typedPath), ...(participant ? [participant] : [])];
});
