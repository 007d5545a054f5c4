// npm test: installs what is missing, runs every stage whether or not one before it failed, and ends with one line that
// counts the tests. Arguments name stages, or a whole suite (day, full, training, nightly), to run those alone.
import { mkdirSync, rmSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { join } from 'node:path';
import { ensureInstalled } from './installation.mjs';
import { main, root, run, SetupError } from './run-command.mjs';
import { countLine, readResults } from './test-results.mjs';
import { limitsSeconds, stages, stagesOf } from './test-stages.mjs';

const reports = join(root, 'artifacts/test-reports');

/** The maximum number of failed tests of a stage that the summary names. */
const maxNamed = 20;

const seconds = (start) => `${((performance.now() - start) / 1000).toFixed(1)} s`;

const heading = (name) => `\n── ${name} ${'─'.repeat(Math.max(3, 70 - name.length))}`;

/** Runs one stage. `quiet`: its output is buffered and printed at its end, for stages that run at the same time. */
async function runStage(name, { quiet = false } = {}) {
  const { commands, runner, chosen, suite } = stages[name];
  const limitSeconds = limitsSeconds[suite];
  const report = join(reports, `${name}.${runner === 'pytest' ? 'xml' : 'json'}`);
  const problems = [];
  const start = performance.now();
  const kept = [heading(name)];
  if (!quiet) console.log(kept[0]);
  try {
    for (const [command, ...args] of await commands(report)) {
      const { code, timedOut, output } = await run(command, args, { limitSeconds, capture: quiet });
      kept.push(output);
      if (timedOut) problems.push(`stopped after ${limitSeconds} s`);
      else if (code !== 0) problems.push(`exit code ${code}`);
    }
  } catch (error) {
    kept.push(error instanceof SetupError ? error.message : error.stack);
    if (!quiet) console.error(kept.at(-1));
    problems.push(error.message.split('\n')[0]);
  }
  if (quiet) console.log(kept.join('\n').trimEnd());
  const results = (runner && readResults(runner, report, chosen)) ?? { passed: 0, failed: 0, skipped: 0, failures: [] };
  if (problems.length === 0 && runner && results.passed + results.failed === 0) problems.push('no test ran');
  // A stage that failed without a failed test (types, lint, a crash) counts as one, so that the last line includes it.
  if (results.failed === 0 && problems.length > 0) results.failed = 1;
  if (results.failed > 0 && problems.length === 0) problems.push(`${results.failed} failed`);
  return { name, results, problems, counted: Boolean(runner), time: seconds(start) };
}

/**
 * Runs the stages in order. Consecutive single-core stages run at the same time, one per core. Any other stage runs
 * alone, except one with `waits`, which runs together with the stages before it.
 */
async function runStages(names) {
  const outcomes = [];
  const running = new Map();
  const waiting = [...names];
  while (waiting.length > 0) {
    const alone = waiting.findIndex((name) => !stages[name].singleCore);
    const beside = waiting.splice(0, alone === -1 ? waiting.length : alone);
    const lane = async () => {
      for (let name = beside.shift(); name; name = beside.shift()) {
        const before = Promise.resolve(running.get(stages[name].after));
        running.set(
          name,
          before.then(() => runStage(name, { quiet: true })),
        );
        outcomes.push(await running.get(name));
      }
    };
    const next = waiting.shift();
    const withNext = next !== undefined && stages[next].waits === true;
    const cores = Math.max(1, availableParallelism() - (withNext ? 1 : 0));
    const lanes = Array.from({ length: Math.min(cores, beside.length) }, lane);
    if (!withNext) await Promise.all(lanes);
    if (next !== undefined) outcomes.push(await runStage(next));
    await Promise.all(lanes);
  }
  return outcomes;
}

function printSummary(outcomes, start) {
  console.log(`\n── summary ${'─'.repeat(63)}`);
  for (const { name, results, problems, counted, time } of outcomes) {
    const words = [counted ? countLine(results) : '', ...problems].filter(Boolean).join('; ');
    console.log(`${problems.length === 0 ? '✓' : '✗'} ${name.padEnd(14)}${time.padStart(8)}  ${words}`);
    // The failures are repeated here, because often only the end of a CI log is kept.
    for (const failure of results.failures.slice(0, maxNamed)) console.log(`✗   ${failure}`);
    if (results.failures.length > maxNamed) console.log(`✗   and ${results.failures.length - maxNamed} more`);
  }
  const failed = outcomes.filter(({ problems }) => problems.length > 0).map(({ name }) => name);
  console.log(`\n${failed.length === 0 ? 'Everything passed' : `Failed: ${failed.join(', ')}`} in ${seconds(start)}.`);
  const total = { passed: 0, failed: 0, skipped: 0 };
  for (const { results } of outcomes) for (const kind of Object.keys(total)) total[kind] += results[kind];
  console.log(countLine(total));
  return failed.length === 0 ? 0 : 1;
}

await main(async () => {
  const start = performance.now();
  const named = process.argv.slice(2);
  const known = (name) => name in stages || stagesOf(name).length > 0;
  const unknown = named.filter((name) => !known(name));
  if (unknown.length > 0) {
    throw new SetupError(`No stage is called ${unknown.join(', ')}; there are: ${Object.keys(stages).join(', ')}`);
  }
  const chosen = (named.length > 0 ? named : ['day']).flatMap((name) => (name in stages ? [name] : stagesOf(name)));
  await ensureInstalled();
  rmSync(reports, { recursive: true, force: true });
  mkdirSync(reports, { recursive: true });
  return printSummary(await runStages(chosen), start);
});
