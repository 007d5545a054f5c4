import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { passedOn } from './command-line.mjs';
import { installWithApt, outputOf, root, run, runQuietly, SetupError } from './run-command.mjs';

const projectFile = join(root, 'training/pyproject.toml');
/** The installer of the packages in pyproject.toml; nothing else needs it. */
const uv = 'uv==0.9.11';
const interpreters = ['python3', 'python3.13', 'python3.12', 'python3.11', 'python'];

/** The lower bound of requires-python, as [major, minor]. */
function neededVersion() {
  const bound = /^requires-python\s*=\s*["']\s*>=\s*(\d+)\.(\d+)/m.exec(readFileSync(projectFile, 'utf8'));
  if (!bound) throw new Error('training/pyproject.toml: expected requires-python = ">=MAJOR.MINOR"');
  return [Number(bound[1]), Number(bound[2])];
}

async function findInterpreter() {
  const [major, minor] = neededVersion();
  const test = `import sys; sys.exit(sys.version_info[:2] < (${major}, ${minor}))`;
  for (const name of process.env.PYTHON ? [process.env.PYTHON] : interpreters) {
    if ((await runQuietly(name, ['-c', test]))?.code === 0) return name;
  }
  return null;
}

async function createVenv(directory) {
  const interpreter = await findInterpreter();
  if (interpreter === null) return `Python ${neededVersion().join('.')} or newer is needed for training and its tests`;
  rmSync(directory, { recursive: true, force: true });
  const { code, output } = await runQuietly(interpreter, ['-m', 'venv', directory]);
  return code === 0 ? null : `${interpreter} -m venv failed:\n${output.trim()}`;
}

const pythonIn = (directory) =>
  process.platform === 'win32' ? join(directory, 'Scripts/python.exe') : join(directory, 'bin/python');

/** Returns the requirements in training/pyproject.toml, read by Python's own TOML parser. */
async function requirements(python, extras) {
  const script = `
import sys, tomllib
project = tomllib.load(open(sys.argv[1], 'rb'))['project']
optional = project.get('optional-dependencies', {})
for requirement in project.get('dependencies', []) + [r for extra in sys.argv[2:] for r in optional[extra]]:
    print(requirement)`;
  const read = ['-c', script, projectFile, ...extras];
  const output = await outputOf(python, read, 'training/pyproject.toml could not be read');
  return output.trim().split(/\r?\n/).filter(Boolean);
}

/**
 * Installs with uv, which takes a quarter of pip's time. Falls back to pip if uv cannot be installed or finds no
 * registry, because pip's configuration may name one.
 */
async function installPackages(python, wanted) {
  const pip = ['-m', 'pip', 'install', '--no-input', '--disable-pip-version-check', '--prefer-binary'];
  if ((await runQuietly(python, [...pip, uv]))?.code === 0) {
    if ((await run(python, ['-m', 'uv', 'pip', 'install', '--python', python, ...wanted])).code === 0) return;
    console.log('uv could not install them; pip tries.');
  }
  const { code } = await run(python, [...pip, ...wanted]);
  if (code !== 0) throw new SetupError(`pip install failed with exit code ${code}; its messages are above.`);
}

/**
 * Returns the path of a Python with the requirements of training/pyproject.toml and these extras. The environment is
 * created in .cache on first use and again when that file changes. Throws a SetupError that says what is missing.
 */
export async function pythonEnvironment({ extras = [] } = {}) {
  const hash = createHash('sha256').update(readFileSync(projectFile)).digest('hex').slice(0, 12);
  const directory = join(root, '.cache', ['python', hash, ...extras].join('-'));
  if (existsSync(join(directory, 'complete'))) return pythonIn(directory);

  mkdirSync(join(root, '.cache'), { recursive: true });
  // The environment is created under a temporary name and renamed, so that a concurrent script never sees half of it.
  const unfinished = `${directory}.${process.pid}`;
  try {
    let problem = await createVenv(unfinished);
    if (problem !== null) {
      await installWithApt('python3', 'python3-venv');
      problem = await createVenv(unfinished);
    }
    if (problem !== null) {
      throw new SetupError(`${problem}\nOn Debian and Ubuntu: sudo apt-get install python3 python3-venv`);
    }
    const python = pythonIn(unfinished);
    const wanted = await requirements(python, extras);
    console.log(`Installing Python packages: ${wanted.join(', ')} ...`);
    await installPackages(python, wanted);
    writeFileSync(join(unfinished, 'complete'), `${wanted.join('\n')}\n`);
    if (!existsSync(join(directory, 'complete'))) {
      rmSync(directory, { recursive: true, force: true });
      renameSync(unfinished, directory);
    }
  } finally {
    rmSync(unfinished, { recursive: true, force: true });
  }
  return pythonIn(directory);
}

/** Runs a module of the training, in an environment with these extras; resolves as `run` does. */
export async function runTraining(module, args, { extras = [], ...options } = {}) {
  const python = await pythonEnvironment({ extras });
  const env = { PYTHONPATH: join(root, 'training'), PYTHONUNBUFFERED: '1' };
  return run(python, ['-m', module, ...args], { env, ...options });
}

/**
 * Returns the people of a folder of motion capture that the report measures: those of its tables, those that the page's
 * paper network was not trained on, and those of another laboratory.
 */
export async function reportPeople(mocap) {
  const list = ['--mocap', mocap];
  const { code, output } = await runTraining('threepoint_training.report_people', list, { capture: true });
  if (code !== 0) throw new SetupError(output.trim());
  return JSON.parse(output);
}

/**
 * Prepares motion capture: recordings with the ground truth, in the folder `out`. `given`: the options mocap, skeleton
 * and people of an npm script. Resolves to an exit code.
 */
export async function prepareRecordings(given, out, options) {
  const args = passedOn({ ...given, out }, ['people', 'mocap', 'skeleton', 'out']);
  return (await runTraining('threepoint_training.recordings', args, options)).code;
}

/**
 * Prepares motion capture in a temporary folder, which `work` reads and may write into; it is deleted, because it holds
 * motion data. `work` returns an exit code. Resolves to it, or to that of a preparation which failed.
 */
export async function withRecordings(given, work, options) {
  const folder = mkdtempSync(join(tmpdir(), 'threepoint-recordings-'));
  try {
    return (await prepareRecordings(given, folder, options)) || (await work(folder));
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}
