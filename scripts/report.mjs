// npm run tool -- report: measures the shipping code path with the cross-validation networks of npm run tool -- train,
// each on people it was not trained on, and renews the tables and figures of docs/accuracy.md; --redraw renews them
// from the last measurement. --legs renews the table of legs alone, with the page's network for the body and the
// cross-validation networks of npm run tool -- train:gait.
import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { passedOn, readOptions } from './command-line.mjs';
import { reportPeople, runTraining } from './python-environment.mjs';
import { main, root, run, SetupError } from './run-command.mjs';

const usage =
  'npm run tool -- report --mocap DIR [--people 005,014] [--skeleton MAP.json] [--models DIR] [--fp32 DIR]\n' +
  'npm run tool -- report --redraw [--models DIR]\n' +
  'npm run tool -- report --legs --mocap DIR [--people 005,014] [--skeleton MAP.json] [--models DIR]\n' +
  'DIR holds .asf and .amc or .bvh files. --people names the people of the tables (default: the varied ones outside ' +
  'the lockbox if DIR has them all, else everyone outside the lockbox, as with --legs); to name people of the ' +
  'lockbox is logged. Those that the networks were not trained on, and another laboratory (901, 902, 903) if DIR has ' +
  'it, are measured with and without calibrated hands. --models names the folder of the networks (default: ' +
  '.cache/cross-validation, which npm run tool -- train writes), --fp32 what npm run tool -- train --fp32 wrote. The command ' +
  'renews docs/accuracy.md.';
// Poses are motion data: they stay in the cache, and only figures of them go into docs.
const measured = join(root, '.cache/report');

function options() {
  const known = { texts: ['people'], paths: ['mocap', 'skeleton', 'models', 'fp32'], flags: ['redraw', 'legs'] };
  return readOptions('report', usage, known, ({ mocap, people, fp32, redraw, legs }) => {
    if (legs && (fp32 || redraw)) throw new Error('--legs is measured by itself');
    if (!mocap === !redraw) throw new Error('either --mocap or --redraw is needed');
    if (redraw && people) throw new Error('--people are measured: with --mocap');
  });
}

/** Runs npm run tool -- evaluate on the given motion with these additional options; resolves to its exit code. */
async function evaluate(given, ...beside) {
  const command = [join(root, 'scripts/evaluate.mjs'), ...passedOn(given, ['mocap', 'skeleton']), ...beside];
  return (await run(process.execPath, command)).code;
}

/** Measures the legs and renews their tables. */
async function reportLegs(given) {
  mkdirSync(measured, { recursive: true });
  const json = join(measured, 'legs.json');
  // Each person is measured with networks that were not trained on them.
  const gaits = join(root, '.cache/gait');
  if (!existsSync(gaits))
    throw new SetupError(`report: there are no networks in ${gaits}; npm run tool -- train:gait makes them\n${usage}`);
  const beside = ['--legs', '--json', json, '--gaits', gaits, ...passedOn(given, ['people', 'models'])];
  const code = await evaluate(given, ...beside);
  return code || (await runTraining('threepoint_training.legs_page', ['--legs', json])).code;
}

/**
 * The measurements of the table of both laboratories: held-out people and another laboratory's, hands as recorded and
 * measured.
 */
const laboratories = Object.fromEntries(
  ['home', 'elsewhere'].map((group) => [
    group,
    ['as-recorded', 'hands-measured'].map((hands) => join(measured, `${group}-${hands}.json`)),
  ]),
);

/** Measures the data of all tables and figures except those of legs; resolves to an exit code. */
async function measure(given, models, { evaluation, figures }) {
  const there = await reportPeople(given.mocap);
  mkdirSync(measured, { recursive: true });
  // Earlier results are deleted, because they may be from other networks or people.
  for (const file of Object.values(laboratories).flat()) rmSync(file, { force: true });
  const people = given.people?.split(',') ?? there.tables;
  const tables = ['--models', models, '--robustness', '--json', evaluation, '--figures', figures];
  if (people.length > 0) tables.push('--people', people.join(','));
  const code = await evaluate(given, ...tables, ...passedOn(given, ['fp32']));
  if (code !== 0) return code;
  const { trainedOn } = JSON.parse(readFileSync(join(models, 'learned.json'), 'utf8'));
  const groups = { home: people.filter((name) => !trainedOn.people.includes(name)), elsewhere: there.elsewhere };
  for (const [group, [asRecorded, handsMeasured]] of Object.entries(laboratories)) {
    const names = groups[group].join(',');
    if (names === '') continue;
    const beside = ['--people', names, '--models', models, '--json'];
    for (const hands of [[asRecorded], [handsMeasured, '--hands-measured']]) {
      console.log(`\n${names}, hands ${hands.length > 1 ? 'measured' : 'as recorded'}`);
      const code = await evaluate(given, ...beside, ...hands);
      if (code !== 0) return code;
    }
  }
  return 0;
}

await main(async () => {
  const given = options();
  if (given.legs) return reportLegs(given);
  const [evaluation, figures] = ['evaluation.json', 'figures.json'].map((name) => join(measured, name));
  const { models = join(root, '.cache/cross-validation') } = given;
  if (!existsSync(join(models, 'learned.json')))
    throw new SetupError(`report: there are no networks in ${models}; npm run tool -- train makes them\n${usage}`);
  if (given.mocap) {
    const code = await measure(given, models, { evaluation, figures });
    if (code !== 0) return code;
  }
  for (const file of [evaluation, figures]) {
    if (!existsSync(file))
      throw new SetupError(`report: ${file} is missing; measure first, with --mocap DIR\n${usage}`);
  }
  const draw = ['--evaluation', evaluation, '--figures', figures, '--models', models];
  for (const [group, files] of Object.entries(laboratories)) draw.push(`--${group}`, ...files);
  return (await runTraining('threepoint_training.accuracy_page', draw, { extras: ['report'] })).code;
});
