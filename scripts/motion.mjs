// npm run motion -- FILE --to bvh|csv|vrma|glb [--estimator NAME] [--out FILE] [--unit m|cm] [--rate HZ] [--avatar
// FILE]: converts a recording of the page, or motion capture as it would be recorded, for other programs
// (docs/motion.md).
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, runProgram, SetupError, typedPath } from './run-command.mjs';

const usage =
  'npm run motion -- FILE --to bvh|csv|vrma|glb [--estimator learned|ik|paper|device] [--out FILE] [--unit m|cm] [--rate HZ] [--avatar FILE]\n' +
  'FILE is a recording that the page made, or motion capture (.bvh, .vrma, .fbx, .glb); docs/motion.md says the rest.';
const twoHours = 2 * 3600;

/** Returns the recording and the options; null: the usage was requested. */
function options() {
  const text = { type: 'string' };
  try {
    const { values, positionals } = parseArgs({
      options: {
        ...{ to: text, estimator: text, out: text, unit: text, rate: text, avatar: text },
        help: { type: 'boolean', short: 'h' },
      },
      allowPositionals: true,
    });
    if (values.help) return null;
    if (positionals.length !== 1) throw new Error(`one file is needed, not ${positionals.length}`);
    if (!values.to) throw new Error('--to is needed');
    return { file: positionals[0], values };
  } catch (error) {
    throw new SetupError(`motion: ${error.message}\n${usage}`);
  }
}

await main(async () => {
  const given = options();
  if (!given) {
    console.log(usage);
    return 0;
  }
  const { file, values } = given;
  await ensureInstalled();
  const request = { ...values, file: typedPath(file) };
  for (const name of ['out', 'avatar']) if (request[name]) request[name] = typedPath(request[name]);
  return runProgram('scripts/motion/main.ts', [JSON.stringify(request)], { limitSeconds: twoHours });
});
