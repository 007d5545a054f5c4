// npm run study:verify -- FILE.zip: recomputes an exported study from its raw records and prints the differences.
import { readOptions, runAsScript } from './command-line.mjs';
import { typedPath } from './run-command.mjs';

await runAsScript('src/study/cli/verify/main.ts', () => {
  const { rest } = readOptions('study:verify', 'npm run study:verify -- FILE.zip', { rest: true }, ({ rest }) => {
    if (rest.length !== 1) throw new Error(`one export is needed, not ${rest.length}`);
  });
  return rest.map(typedPath);
});
