// npm run tool -- train --mocap DIR: trains the networks of public/models on motion capture, in a Python environment
// with PyTorch.
import { runTraining } from './python-environment.mjs';
import { main, typedPath } from './run-command.mjs';

await main(async () => {
  // Paths are relative to the directory in which the command was typed.
  const options = { extras: ['train'], cwd: typedPath('.') };
  return (await runTraining('threepoint_training', process.argv.slice(2), options)).code;
});
