// npm run check:headset -- FILE …: validates the files that the page /check writes, and prints their figures. Exits
// with 1 and a sentence that names the place if a file is invalid.
import { ensureInstalled } from './installation.mjs';
import { main, runProgram, SetupError, typedPath } from './run-command.mjs';

await main(async () => {
  const files = process.argv.slice(2);
  if (files.length === 0 || files.some((file) => file.startsWith('-')))
    throw new SetupError('check:headset: expected files of headset checks\nnpm run check:headset -- FILE …');
  await ensureInstalled();
  return runProgram('bench/evaluate/check-headset.ts', files.map(typedPath));
});
