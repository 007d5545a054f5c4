// node scripts/test.mjs [--nightly] GROUP …: installs what is missing, runs npm scripts whether or not one before
// failed, and ends with one line that counts the tests. Groups run in turn; the scripts of a group, separated by
// commas, run side by side, one per core. --nightly: with more cases and longer runs.
import { mkdirSync, rmSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { ensureInstalled } from './installation.mjs';
import { main } from './run-command.mjs';
import { countLine, readResults, reports } from './test-results.mjs';

/** The maximum number of failed tests of a script that the summary names. */
const maxNamed = 20;

/** Runs the scripts of a group; returns each with its exit code. */
async function runGroup(scripts) {
  const { default: runAll } = await import('npm-run-all2');
  const parallel = scripts.length > 1 && { parallel: true, aggregateOutput: true, maxParallel: availableParallelism() };
  const output = { stdout: process.stdout, stderr: process.stderr, printName: true, silent: true };
  return runAll(scripts, { continueOnError: true, ...output, ...parallel }).catch((error) => {
    if (!error.results) throw error;
    return error.results;
  });
}

/** Prints the outcome of a script; returns its counts. */
function summarise({ name, code }) {
  const results = readResults(name);
  const isRed = code !== 0 || results?.failed > 0;
  const { passed = 0, failed = 0, skipped = 0, failures = [], repeated = [] } = results ?? {};
  const words = [results ? countLine(results) : '', isRed ? `exit code ${code}` : ''].filter(Boolean).join('; ');
  // The failures are repeated here, because often only the end of a CI log is kept.
  const more = failures.length - maxNamed;
  const named = [...failures.slice(0, maxNamed), ...(more > 0 ? [`and ${more} more`] : [])];
  // A script that failed without a failed test (types, lint, a crash) counts as one, so that the last line includes it.
  return {
    lines: [
      `${isRed ? '✗' : '✓'} ${name.padEnd(14)}  ${words}`.trimEnd(),
      ...named.map((failure) => `✗   ${failure}`),
      ...repeated.map((title) => `↻   passed only when repeated: ${title}`),
    ],
    counts: { passed, failed: isRed ? Math.max(1, failed) : 0, skipped },
  };
}

await main(async () => {
  const start = performance.now();
  await ensureInstalled();
  const summaries = [];
  const groups = process.argv.slice(2).filter((argument) => argument !== '--nightly');
  if (groups.length < process.argv.length - 2) {
    process.env.PROPERTY_RUNS ??= '5000';
    process.env.STUDY_KILLS ??= '1000';
  }
  for (const group of groups) {
    rmSync(reports, { recursive: true, force: true });
    mkdirSync(reports, { recursive: true });
    summaries.push(...(await runGroup(group.split(','))).map(summarise));
  }
  const seconds = ((performance.now() - start) / 1000).toFixed(0);
  console.log(`\n── summary, after ${seconds} s ${'─'.repeat(50)}`);
  for (const { lines } of summaries) console.log(lines.join('\n'));
  const sum = (kind) => summaries.reduce((total, { counts }) => total + counts[kind], 0);
  console.log(countLine({ passed: sum('passed'), failed: sum('failed'), skipped: sum('skipped') }));
  return sum('failed') === 0 ? 0 : 1;
});
