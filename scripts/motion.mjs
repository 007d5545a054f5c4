// npm run motion -- FILE --to bvh|csv|vrma|glb [--estimator NAME] [--out FILE] [--unit m|cm] [--rate HZ] [--avatar
// FILE]: converts a recording of the page, or motion capture as it would be recorded, for other programs
// (docs/motion.md).
import { readOptions, runAsScript } from './command-line.mjs';
import { typedPath } from './run-command.mjs';

const usage =
  'npm run motion -- FILE --to bvh|csv|vrma|glb [--estimator learned|ik|paper|device] [--out FILE] [--unit m|cm] [--rate HZ] [--avatar FILE]\n' +
  'FILE is a recording that the page made, or motion capture (.bvh, .vrma, .fbx, .glb); docs/motion.md says the rest.';
const texts = ['to', 'estimator', 'out', 'unit', 'rate', 'avatar'];
const twoHours = 2 * 3600;

function request() {
  const { rest, ...given } = readOptions('motion', usage, { texts, rest: true }, ({ rest, to }) => {
    if (rest.length !== 1) throw new Error(`one file is needed, not ${rest.length}`);
    if (!to) throw new Error('--to is needed');
  });
  const paths = { ...given, file: rest[0] };
  for (const name of ['file', 'out', 'avatar']) if (paths[name]) paths[name] = typedPath(paths[name]);
  return [JSON.stringify(paths)];
}

if (process.argv.some((word) => word === '--help' || word === '-h')) console.log(usage);
else await runAsScript('scripts/motion/main.ts', request, { limitSeconds: twoHours });
