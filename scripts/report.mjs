// npm run report -- --mocap DIR [--skeleton MAP.json] [--models DIR] [--fp32 DIR]: measures the shipping path with the networks that
// npm run train left without their fold's people, and renews the tables and figures of docs/accuracy.md. npm run report -- --redraw: the
// same from what was measured last. npm run report -- --legs --mocap DIR: the tables of legs alone, with the page's network for the body
// and those that npm run train:gait left for the gait of people they have not seen.
import { existsSync, mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { pythonEnvironment } from './python-environment.mjs';
import { main, root, run, SetupError } from './run-command.mjs';

const usage =
  'npm run report -- --mocap DIR [--skeleton MAP.json] [--models DIR] [--fp32 DIR]\n' +
  'npm run report -- --redraw [--models DIR]\n' +
  'npm run report -- --legs --mocap DIR [--skeleton MAP.json] [--models DIR]\n' +
  'DIR holds .asf and .amc or .bvh files; models the networks of a cross-validation (.cache/cross-validation, where npm run train leaves ' +
  'them); fp32 what npm run train -- --fp32 wrote. docs/accuracy.md is renewed.';
const sixHours = 6 * 3600;

function options() {
  const text = { type: 'string' };
  try {
    const { values } = parseArgs({
      options: {
        mocap: text,
        skeleton: text,
        models: text,
        fp32: text,
        redraw: { type: 'boolean' },
        legs: { type: 'boolean' },
      },
    });
    if (values.legs && (values.fp32 || values.redraw)) throw new Error('--legs is measured by itself');
    if (!values.mocap === !values.redraw) throw new Error('either --mocap or --redraw is needed');
    return values;
  } catch (error) {
    throw new SetupError(`report: ${error.message}\n${usage}`);
  }
}

const path = (name) => resolve(process.env.INIT_CWD ?? process.cwd(), name);

/** Measures legs and renews their tables. */
async function reportLegs({ mocap, skeleton, models }) {
  const measured = join(root, '.cache/report');
  mkdirSync(measured, { recursive: true });
  const json = join(measured, 'legs.json');
  const evaluate = [join(root, 'scripts/evaluate.mjs'), '--legs', '--mocap', path(mocap), '--json', json];
  if (skeleton) evaluate.push('--skeleton', path(skeleton));
  if (models) evaluate.push('--models', path(models));
  // People are measured with networks that have not seen them.
  const gaits = join(root, '.cache/gait');
  if (!existsSync(gaits))
    throw new SetupError(`report: there are no networks in ${gaits}; npm run train:gait makes them\n${usage}`);
  evaluate.push('--gaits', gaits);
  const { code } = await run(process.execPath, evaluate, { cwd: root, limitSeconds: sixHours });
  if (code !== 0) return code;
  const renew = ['-m', 'threepoint_training.legs_page', '--legs', json];
  const env = { PYTHONPATH: `${root}/training` };
  return (await run(await pythonEnvironment(), renew, { cwd: root, env, limitSeconds: 600 })).code;
}

await main(async () => {
  const given = options();
  if (given.legs) return reportLegs(given);
  // Poses are motion data: they stay in the cache, only pictures of them go into docs.
  const measured = join(root, '.cache/report');
  const [evaluation, figures] = ['evaluation.json', 'figures.json'].map((name) => join(measured, name));
  const models = given.models ? path(given.models) : join(root, '.cache/cross-validation');
  if (!existsSync(join(models, 'learned.json')))
    throw new SetupError(`report: there are no networks in ${models}; npm run train makes them\n${usage}`);
  if (given.mocap) {
    mkdirSync(measured, { recursive: true });
    const evaluate = [join(root, 'scripts/evaluate.mjs'), '--mocap', path(given.mocap), '--models', models];
    evaluate.push('--robustness', '--json', evaluation, '--figures', figures);
    for (const name of ['skeleton', 'fp32']) if (given[name]) evaluate.push(`--${name}`, path(given[name]));
    const { code } = await run(process.execPath, evaluate, { cwd: root, limitSeconds: sixHours });
    if (code !== 0) return code;
  }
  for (const file of [evaluation, figures]) {
    if (!existsSync(file))
      throw new SetupError(`report: ${file} is missing; measure first, with --mocap DIR\n${usage}`);
  }
  const python = await pythonEnvironment({ extras: ['report'] });
  const draw = [
    '-m',
    'threepoint_training.accuracy_page',
    '--evaluation',
    evaluation,
    '--figures',
    figures,
    '--models',
    models,
  ];
  const { code } = await run(python, draw, { cwd: root, env: { PYTHONPATH: `${root}/training` }, limitSeconds: 600 });
  return code;
});
