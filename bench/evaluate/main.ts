import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import type { Calibration } from '../../src/core/body/calibration';
import { forwardKinematics } from '../../src/core/body/forward-kinematics';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { createEstimator, needsRegressor } from '../../src/core/estimation/estimators';
import type { EstimatorName } from '../../src/core/estimation/pose-estimator';
import type { PoseRegressor } from '../../src/core/estimation/pose-regressor';
import type { Vec3 } from '../../src/core/math/vec3';
import { parseContract, startRegressor } from '../../src/inference/load-regressor';
import {
  addClip,
  emptyMeasures,
  type MeasuredFrame,
  type Measures,
  merge,
  type Report,
  report,
  reportNames,
} from './measures';
import { calibrationOf, type RecordedFrame, readClip, readIndex } from './recordings';

/** Methods that have a body to measure; hands-only has none. */
const measured = ['ik', 'paper', 'learned'] as const satisfies readonly EstimatorName[];
type Measured = (typeof measured)[number];

const { values: options } = parseArgs({
  options: {
    recordings: { type: 'string' },
    models: { type: 'string' },
    json: { type: 'string' },
  },
});

/** Drives the shipping path over one clip, frame by frame as the page would. */
async function drive(
  name: Measured,
  calibration: Calibration,
  regressor: PoseRegressor | null,
  frames: readonly RecordedFrame[],
): Promise<MeasuredFrame[]> {
  const estimator = createEstimator(name, calibration, regressor);
  const skeleton = skeletonFromCalibration(calibration);
  const result: MeasuredFrame[] = [];
  for (const { frame, truth } of frames) {
    await estimator.prepare(frame);
    const { body } = estimator.estimate(frame);
    if (estimator.fault()) throw new Error(`${name}: ${estimator.fault()}`);
    if (!body || !frame.leftHand || !frame.rightHand) throw new Error(`${name} drew no body`);
    const joints: Record<string, Vec3> = {};
    for (const [joint, { position }] of Object.entries(forwardKinematics(skeleton, body))) joints[joint] = position;
    result.push({
      joints,
      truth,
      raw: estimator.rawJoints(),
      wrists: { left: frame.leftHand.position, right: frame.rightHand.position },
    });
  }
  return result;
}

async function main(): Promise<void> {
  const { recordings, models, json } = options;
  if (!recordings || !models)
    throw new Error('evaluate: --recordings and --models are needed; `npm run evaluate` gives them');
  const index = readIndex(recordings);
  const regressors = new Map<Measured, PoseRegressor>();
  const seen = new Set<string>();
  for (const name of measured.filter(needsRegressor)) {
    const contract = parseContract(`${name}.json`, readFileSync(join(models, `${name}.json`), 'utf8'));
    regressors.set(name, await startRegressor(contract, readFileSync(join(models, contract.file))));
    for (const person of contract.trainedOn.people) seen.add(person);
  }

  const byPerson = new Map<string, Record<Measured, Measures>>();
  let done = 0;
  const total = index.clips.reduce((sum, clip) => sum + clip.frames, 0);
  for (const clip of index.clips) {
    const calibration = calibrationOf(index, clip.person);
    const person = byPerson.get(clip.person) ?? {
      ik: emptyMeasures(),
      paper: emptyMeasures(),
      learned: emptyMeasures(),
    };
    byPerson.set(clip.person, person);
    const frames = readClip(recordings, index, clip);
    for (const name of measured) {
      addClip(person[name], await drive(name, calibration, regressors.get(name) ?? null, frames), index.rateHz);
    }
    done += clip.frames;
    if (process.stderr.isTTY) process.stderr.write(`\r  ${clip.name} ${Math.round((100 * done) / total)} %   `);
  }
  if (process.stderr.isTTY) process.stderr.write('\r\x1b[K');

  const people = [...byPerson.keys()].sort();
  const over = (who: readonly string[]): Record<Measured, Report> =>
    Object.fromEntries(
      measured.map((name) => [name, report(merge(who.flatMap((person) => byPerson.get(person)?.[name] ?? [])))]),
    ) as Record<Measured, Report>;
  const unseen = people.filter((person) => !seen.has(person));
  const result = {
    corpus: {
      clips: index.clips.length,
      people: people.length,
      frames: total,
      seconds: Number((total / index.rateHz).toFixed(1)),
    },
    estimators: over(people),
    ...(unseen.length > 0 && unseen.length < people.length ? { unseen: over(unseen) } : {}),
    people: Object.fromEntries(people.map((person) => [person, { seen: seen.has(person), ...over([person]) }])),
    problems: index.problems,
  };

  console.log(
    `\n${result.corpus.clips} clips, ${result.corpus.people} people, ${(result.corpus.seconds / 60).toFixed(1)} minutes at ${index.rateHz} Hz`,
  );
  for (const problem of index.problems) console.log(`  ${problem}`);
  const told = (who: readonly string[]) =>
    who.map((person) => (seen.has(person) ? `${person} (seen)` : person)).join(', ');
  print(`All: ${told(people)}`, result.estimators);
  if (result.unseen) print(`Never trained on: ${unseen.join(', ')}`, result.unseen);
  for (const person of people) {
    const own = result.people[person];
    if (own && people.length > 1) {
      const row = measured.map((name) => `${name} ${own[name].mpjpeCm.mean.toFixed(2)}`).join('   ');
      console.log(`  ${person}${own.seen ? ' (seen)' : ''}: MPJPE [cm]  ${row}`);
    }
  }
  if (json) writeFileSync(json, `${JSON.stringify(result, null, 2)}\n`);
}

function print(title: string, reports: Record<Measured, Report>): void {
  console.log(`\n${title}`);
  const row = (label: string, cells: readonly string[]) =>
    console.log(`  ${label.padEnd(34)}${cells.map((cell) => cell.padStart(22)).join('')}`);
  row('', [...measured]);
  const spreadCell = ({ mean, median, p95 }: Report['mpjpeCm']) =>
    `${mean.toFixed(2)} / ${median.toFixed(2)} / ${p95.toFixed(2)}`;
  const each = (cell: (r: Report) => string) => measured.map((name) => cell(reports[name]));
  row(
    'MPJPE mean / median / p95 [cm]',
    each((r) => spreadCell(r.mpjpeCm)),
  );
  for (const name of reportNames)
    row(
      `  ${name}`,
      each((r) => spreadCell(r.joints[name])),
    );
  row(
    'network alone, MPJPE [cm]',
    each((r) => r.rawMpjpeCm?.toFixed(2) ?? '–'),
  );
  row(
    'elbow swivel error [°]',
    each((r) => r.swivelDeg.toFixed(1)),
  );
  row(
    'MSE per coordinate [cm²]',
    each((r) => r.mseCm2.toFixed(2)),
  );
  row(
    'MAE per coordinate [cm]',
    each((r) => r.maeCm.toFixed(2)),
  );
  row(
    'jerk against the truth',
    each((r) => `${r.jerkRatio.toFixed(2)} ×`),
  );
  row(
    'bone-length variation [mm]',
    each((r) => r.boneVariationMm.toFixed(3)),
  );
  row(
    'hand error mean / max [mm]',
    each((r) => `${r.handErrorMm.toFixed(3)} / ${r.handErrorMaxMm.toFixed(1)}`),
  );
}

await main().catch((error: unknown) => {
  console.error(error instanceof Error ? error.message : error);
  process.exitCode = 1;
});
