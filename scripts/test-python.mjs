// npm run test:python [-- --training]: runs the tests of the training that need no PyTorch, or those that train, in the
// Python environment of either.
import { pythonEnvironment } from './python-environment.mjs';
import { main, run } from './run-command.mjs';
import { reports } from './test-results.mjs';

await main(async () => {
  const trains = process.argv.includes('--training');
  const python = await pythonEnvironment({ extras: trains ? ['train'] : [] });
  const marker = trains ? 'training' : 'not training';
  const pytest = ['-m', 'pytest', 'training', '-m', marker, '-p', 'no:cacheprovider'];
  // The matrices are small: threads for them wait for each other most of the time.
  const env = { OPENBLAS_NUM_THREADS: '1' };
  return (await run(python, [...pytest, `--junitxml=${reports}/python.xml`], { env })).code;
});
