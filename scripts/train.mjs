// npm run tool -- train --mocap DIR: trains the networks of public/models on motion capture, in a Python environment
// with PyTorch. With --board: compares methods (train-board.mjs).
import { runTraining } from './python-environment.mjs';
import { main, typedPath } from './run-command.mjs';
import { trainBoard } from './train-board.mjs';

await main(async () => {
  const given = process.argv.slice(2);
  if (given.includes('--board') && !given.includes('--help')) return trainBoard();
  // Paths are relative to the directory in which the command was typed.
  const options = { extras: ['train'], cwd: typedPath('.') };
  return (await runTraining('threepoint_training', given, options)).code;
});
