// npm run tool -- NAME [OPTION …]: runs a tool that is needed rarely; without a name it lists them. Most are TypeScript
// programs: their options are checked here, and they start once all packages are there. A program gets the options as
// JSON, unless `argumentsOf` says otherwise.
import { basename, join } from 'node:path';
import { readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { mainOf, root, run, runProgram, SetupError, typedPath } from './run-command.mjs';

/** Returns a check that exactly one argument without a name is given. */
const oneArgument =
  (what) =>
  ({ rest }) => {
    if (rest.length !== 1) throw new Error(`one ${what} is needed, not ${rest.length}`);
  };

const planOf = ({ rest, plan }) => [...rest, ...(plan ? [plan] : [])];

/**
 * The programs by the names of their tools: how each is used, its options as `readOptions` takes them, and the
 * check of them.
 */
const programs = {
  /** Measures how many clients a relay process carries, next to a plain socket.io relay. */
  'bench:relay': {
    program: 'bench/relay/main.ts',
    usage: 'npm run tool -- bench:relay [--json FILE] [--quick] [--rooms N,N] [--hz N,N] [--seconds N]',
    options: { texts: ['rooms', 'hz', 'seconds'], paths: ['json'], flags: ['quick'] },
  },
  /** Measures concurrent participants of a study on one server. --flush-ms delays each flush of the disk, by strace. */
  'bench:study': {
    program: 'bench/study-load.ts',
    usage: 'npm run tool -- bench:study [--participants 200 --seconds 60 --flush-ms 25 --json FILE]',
    options: { texts: ['participants', 'seconds', 'flush-ms'], paths: ['json'] },
  },
  /** Validates the files that the page /check writes, and prints their figures. */
  'check:headset': {
    program: 'bench/evaluate/check-headset.ts',
    usage: 'npm run tool -- check:headset FILE …',
    options: { rest: 'paths' },
    check({ rest }) {
      if (rest.length === 0) throw new Error('expected files of headset checks');
    },
    argumentsOf: ({ rest }) => rest,
  },
  /** Converts a recording, or motion capture as it would be recorded, for other programs (docs/motion.md). */
  motion: {
    program: 'scripts/motion/main.ts',
    usage:
      'npm run tool -- motion FILE --to bvh|csv|vrma|glb [--estimator learned|ik|paper|paper-published|device] [--out FILE] [--unit m|cm] [--rate HZ] [--avatar FILE]\n' +
      'FILE is a recording that the page made, or motion capture (.bvh, .vrma, .fbx, .glb); docs/motion.md says the rest.',
    options: { texts: ['to', 'estimator', 'unit', 'rate'], paths: ['out', 'avatar'], rest: 'paths' },
    check(given) {
      oneArgument('file')(given);
      if (!given.to) throw new Error('--to is needed');
    },
    argumentsOf: ({ rest: [file], ...given }) => [JSON.stringify({ ...given, file })],
  },
  /** Reads every file of motion of a folder, and prints what was read and assumed, a line each (docs/motion.md). */
  'motion:try': {
    program: 'scripts/motion/try-files.ts',
    usage: 'npm run tool -- motion:try DIR',
    options: { rest: 'paths' },
    check: oneArgument('folder'),
    argumentsOf: ({ rest }) => rest,
  },
  /** Runs the tests that report figures of docs/reliability.json, and writes docs/reliability.md. */
  reliability: {
    program: 'scripts/reliability/main.ts',
    usage:
      'npm run tool -- reliability [--unit | --long | --redraw]\n' +
      '--unit: without a browser. --long: also twenty minutes of play. --redraw: writes the page from the last figures.',
    options: { flags: ['unit', 'long', 'redraw'] },
  },
  /** Prints the errors of a plan, or its duration and what its participants see. */
  'study:check': {
    program: 'src/study/cli/check/main.ts',
    usage: 'npm run tool -- study:check PLAN.json [--participant P01]',
    options: { texts: ['participant'], rest: 'paths' },
    check: oneArgument('plan'),
    argumentsOf: ({ rest, participant }) => [...rest, ...(participant ? [participant] : [])],
  },
  /** Prints how many participants a study needs. */
  'study:power': {
    program: 'src/study/cli/power/main.ts',
    usage:
      'npm run tool -- study:power --effect 0.5 [--margin 0.5] [--design paired|between] [--power 0.8] [--alpha 0.05] [--studies 10000] [--seed 1]',
    options: { texts: ['effect', 'margin', 'design', 'power', 'alpha', 'studies', 'seed'] },
    argumentsOf: ({ rest: _, ...given }) => [JSON.stringify(given)],
  },
  /** Simulates a whole study, with simulated participants in the real sessions, store and exports (docs/study.md). */
  'study:simulate': {
    program: 'src/study/cli/simulate/main.ts',
    usage:
      'npm run tool -- study:simulate [STUDY.json] [--out DIR] [--participants 15] [--seed NUMBER] [--effect CONDITION=POINTS …] ' +
      '[--score-effect CONDITION=CHANCE …]\n' +
      "Without a study: the paper's. DIR must be empty or new: simulated files are never put among others.",
    options: {
      texts: ['participants', 'seed'],
      paths: ['out', 'plan'],
      lists: ['effect', 'score-effect'],
      rest: 'paths',
    },
    check(given) {
      const plans = planOf(given);
      if (plans.length > 1) throw new Error(`one study at a time, not ${plans.join(' and ')}`);
    },
    argumentsOf(given) {
      const [plan = join(root, 'public/studies/paper.json')] = planOf(given);
      const { out = typedPath(`SIMULATED-${basename(plan, '.json')}`) } = given;
      return [JSON.stringify({ ...given, plan, out })];
    },
  },
  /** Recomputes an exported study from its raw records and prints the differences. */
  'study:verify': {
    program: 'src/study/cli/verify/main.ts',
    usage: 'npm run tool -- study:verify FILE.zip',
    options: { rest: 'paths' },
    check: oneArgument('export'),
    argumentsOf: ({ rest }) => rest,
  },
};

/** The tools that are scripts of their own. */
export const scriptTools = [
  ...['train', 'train:gait', 'evaluate', 'report', 'paper', 'goldens', 'renew'],
  ...['pictures', 'bench', 'avatars:fetch', 'avatars:try'],
];

/** Returns the path of the script of a tool. */
export const scriptOf = (name) => join(root, 'scripts', `${name.replace(':', '-')}.mjs`);

await mainOf(import.meta.url, async () => {
  // The name is taken out of the arguments; what is left are those of the tool.
  const [name] = process.argv.splice(2, 1);
  if (scriptTools.includes(name)) return (await run(process.execPath, [scriptOf(name), ...process.argv.slice(2)])).code;
  if (!(name in programs)) {
    throw new SetupError(`The tools are: ${[...scriptTools, ...Object.keys(programs)].toSorted().join(', ')}`);
  }
  const { program, usage, options, check, argumentsOf = (given) => [JSON.stringify(given)] } = programs[name];
  if (process.argv.some((word) => word === '--help' || word === '-h')) {
    console.log(usage);
    return 0;
  }
  const programArguments = argumentsOf(readOptions(name, usage, options, check));
  await ensureInstalled();
  return runProgram(program, programArguments);
});
