import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { type RowName, rows } from '../../tests/reliability/rows';
import { type Figures, merge, missingFigures, reliabilityPage } from './reliability-page';

const root = fileURLToPath(new URL('../..', import.meta.url));
const figuresFile = `${root}artifacts/reliability.jsonl`;
const storedFile = `${root}docs/reliability.json`;
const page = `${root}docs/reliability.md`;
const [unitOnly, long, redraw] = ['--unit', '--long', '--redraw'].map((option) => process.argv.includes(option));

const files = [...new Set(Object.values(rows).flatMap(({ tests }) => tests))];
const suites = {
  unit: files.filter((file) => file.startsWith('tests/')),
  e2e: files.filter((file) => file.startsWith('e2e/')),
};

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
  passed = runTests('vitest/vitest.mjs', ['run', ...suites.unit]);
  if (!unitOnly) {
    const skip = long ? [] : ['--grep-invert', '@long'];
    passed = runTests('@playwright/test/cli.js', ['test', ...suites.e2e, ...skip]) && passed;
  }
}

const before = existsSync(storedFile) ? (JSON.parse(readFileSync(storedFile, 'utf8')) as Figures) : {};
const lines = existsSync(figuresFile) ? readFileSync(figuresFile, 'utf8').trim().split('\n').filter(Boolean) : [];
const figures = merge(
  before,
  lines.map((line) => JSON.parse(line) as { row: RowName; figures: Record<string, string | number> }),
);
writeFileSync(storedFile, `${JSON.stringify(figures, null, 2)}\n`);
writeFileSync(page, reliabilityPage(figures));
const missing = missingFigures(figures);
if (missing.length > 0) console.error(`Nothing is measured yet for: ${missing.join(', ')}.`);
console.log('docs/reliability.md is written.');
process.exitCode = passed && missing.length === 0 ? 0 : 1;
