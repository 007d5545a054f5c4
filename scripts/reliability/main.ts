import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { addFigures, missingFigures, type Register, reliabilityPage } from './reliability-page';

const root = fileURLToPath(new URL('../..', import.meta.url));
const figuresFile = `${root}artifacts/reliability.jsonl`;
const storedFile = `${root}docs/reliability.json`;
const page = `${root}docs/reliability.md`;
/** The options of the npm script. */
const { unit, long, redraw } = JSON.parse(process.argv[2] ?? '{}') as Partial<
  Record<'unit' | 'long' | 'redraw', boolean>
>;

/** Returns the test files of a folder that report figures. */
const measuring = (folder: string): string[] =>
  readdirSync(root + folder, { recursive: true, encoding: 'utf8' })
    .filter((file) => /\.(test|spec)\.ts$/.test(file))
    .map((file) => `${folder}/${file.replaceAll('\\', '/')}`)
    .filter((file) => readFileSync(root + file, 'utf8').includes('reportFigures('));

function runTests(script: string, args: readonly string[]): boolean {
  const env = { ...process.env, RELIABILITY_FIGURES: figuresFile, THREEPOINT_NIGHTLY: '1' };
  return (
    spawnSync(process.execPath, [`node_modules/${script}`, ...args], { cwd: root, env, stdio: 'inherit' }).status === 0
  );
}

let passed = true;
if (!redraw) {
  mkdirSync(`${root}artifacts`, { recursive: true });
  rmSync(figuresFile, { force: true });
  passed = runTests('vitest/vitest.mjs', ['run', ...measuring('tests')]);
  if (!unit) {
    const skip = long ? [] : ['--grep-invert', '@long'];
    passed = runTests('@playwright/test/cli.js', ['test', ...measuring('e2e'), ...skip]) && passed;
  }
}

const register: Register = JSON.parse(readFileSync(storedFile, 'utf8'));
const lines = existsSync(figuresFile) ? readFileSync(figuresFile, 'utf8').trim().split('\n').filter(Boolean) : [];
addFigures(
  register,
  lines.map((line) => JSON.parse(line)),
);
writeFileSync(storedFile, `${JSON.stringify(register, null, 2)}\n`);
writeFileSync(page, reliabilityPage(register));
const missing = missingFigures(register);
if (missing.length > 0) console.error(`Nothing is measured yet for: ${missing.join(', ')}.`);
console.log('docs/reliability.md is written.');
process.exitCode = passed && missing.length === 0 ? 0 : 1;
