// npm run train -- --mocap DIR: trains the networks of public/models on motion capture, in a Python environment with
// PyTorch.
import { pythonEnvironment } from './python-environment.mjs';
import { main, root, run } from './run-command.mjs';

const oneDay = 24 * 3600;

await main(async () => {
  const python = await pythonEnvironment({ extras: ['train'] });
  const { code } = await run(python, ['-m', 'threepoint_training', ...process.argv.slice(2)], {
    // Paths are relative to the directory in which the command was typed.
    cwd: process.env.INIT_CWD ?? root,
    env: { PYTHONPATH: `${root}/training`, PYTHONUNBUFFERED: '1' },
    limitSeconds: oneDay,
  });
  return code;
});
