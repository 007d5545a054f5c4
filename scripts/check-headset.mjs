// npm run check:headset -- FILE …: validates the files that the page /check writes, and prints their figures. Exits
// with 1 and a sentence that names the place if a file is invalid.
import { readOptions, runAsScript } from './command-line.mjs';
import { typedPath } from './run-command.mjs';

await runAsScript('bench/evaluate/check-headset.ts', () => {
  const { rest } = readOptions('check:headset', 'npm run check:headset -- FILE …', { rest: true }, ({ rest }) => {
    if (rest.length === 0) throw new Error('expected files of headset checks');
  });
  return rest.map(typedPath);
});
