import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { parseArgs } from 'node:util';
import { exportFiles, exportName, exportZip } from '../../server/study-export';
import { openStudyStore } from '../../server/study-store';
import { compareAnswers, compareScores } from '../../src/core/study/compare-conditions';
import { checkedPlan, parsePlan } from '../../src/core/study/plan';
import { answersIn, trialsIn } from '../../src/core/study/study-tables';
import { ValidationError } from '../../src/core/study/validation';
import { nullAnswerModel, plantedAnswerModel } from './answer-model';
import { statedPerformanceModel } from './performance-model';
import { simulatedPlan, simulateStudy } from './simulate-study';

/** When the first simulated participant begins: a fixed day, so that the same seed gives the same files. */
const firstSession = Date.UTC(2026, 0, 5, 9) / 1000;

function options() {
  const text = { type: 'string' } as const;
  const { values } = parseArgs({
    options: { participants: text, out: text, seed: text, effect: text, plan: text },
  });
  if (!values.out || !values.plan) throw new ValidationError('', 'both --out and --plan are needed');
  const whole = (name: 'participants' | 'seed') => {
    const given = values[name];
    if (given === undefined) return null;
    if (!/^\d{1,9}$/.test(given)) throw new ValidationError(`--${name}`, `expected a whole number, not "${given}"`);
    return Number(given);
  };
  const effect = Number(values.effect ?? 0);
  if (!Number.isFinite(effect)) throw new ValidationError('--effect', `expected a number, not "${values.effect}"`);
  return { out: values.out, plan: values.plan, participants: whole('participants'), seed: whole('seed'), effect };
}

function run(): void {
  const { out, plan: planFile, participants, seed: givenSeed, effect } = options();
  if (existsSync(out) && readdirSync(out).length > 0) {
    throw new ValidationError('--out', `${out} is not empty: simulated files are never put among others`);
  }
  if (!existsSync(planFile)) throw new ValidationError('--plan', `there is no file ${planFile}`);
  const shipped = parsePlan(readFileSync(planFile, 'utf8'), planFile);
  const seed = givenSeed ?? shipped.seed;
  const plan = checkedPlan(simulatedPlan({ ...shipped, seed, ...(participants !== null && { participants }) }));
  const [baseline, treated] = plan.conditions;
  if (!baseline || !treated) throw new ValidationError('conditions', 'expected at least two conditions to compare');
  const models = {
    answers: effect === 0 ? nullAnswerModel : plantedAnswerModel(treated.id, effect),
    performance: statedPerformanceModel,
  };
  const simulated = simulateStudy(plan, models, seed, firstSession);

  const write = (path: string, content: string | Uint8Array) => {
    mkdirSync(dirname(join(out, path)), { recursive: true });
    writeFileSync(join(out, path), content);
  };
  mkdirSync(out, { recursive: true });
  const store = openStudyStore(join(out, 'SIMULATED-studies.db'));
  try {
    const { retentionUntil } = store.addStudy(plan, { simulated: true, at: firstSession });
    for (const { participant, records, progress } of simulated) {
      store.claim(plan.id, participant, firstSession);
      store.storeRecords(plan.id, participant, records, firstSession);
      store.saveProgress(plan.id, participant, progress, firstSession);
    }
    const content = (participant?: string) => {
      const records = store.records(plan.id, participant);
      return { plan, simulated: true, records, motion: [], at: firstSession, retentionUntil };
    };
    const all = content();
    const name = exportName(all);
    write(`${name}.zip`, exportZip(all));
    for (const [file, text] of Object.entries(exportFiles(all))) write(join(name, file), text);
    for (const { participant } of simulated) {
      const own = content(participant);
      write(join('participants', `${exportName(own, participant)}.zip`), exportZip(own, participant));
    }
    const conditions: [string, string] = [treated.id, baseline.id];
    const answers = compareAnswers(answersIn(all.records, plan), conditions);
    const scores = compareScores(trialsIn(all.records), conditions);
    write('SIMULATED-models.json', `${JSON.stringify({ simulated: true, seed, effect, models }, null, 2)}\n`);
    write('SIMULATED-results.json', `${JSON.stringify({ simulated: true, conditions, answers, scores }, null, 2)}\n`);

    console.log(`SIMULATED study of ${simulated.length} participants, ${all.records.length} records, seed ${seed}.`);
    console.log(
      `Put in: ${effect} points for "${treated.id}". ${conditions.join(' − ')}, paired t-tests, Holm over all questions:`,
    );
    for (const { of, test, holmP } of answers.comparisons) {
      const numbers =
        test?.t == null
          ? 'all differences alike'
          : `t(${test.df}) = ${test.t.toFixed(2)}, Holm p = ${holmP?.toFixed(4)}`;
      console.log(`  ${of.padEnd(4)} ${numbers}`);
    }
    for (const { of, first, second, test } of scores.points.comparisons) {
      const p = test?.p == null ? '' : `, p = ${test.p.toFixed(3)}`;
      console.log(`  ${of}: ${first?.mean.toFixed(2)} against ${second?.mean.toFixed(2)} points (n = ${test?.n})${p}`);
    }
    console.log(`Left out: ${answers.excluded.length + scores.points.excluded.length}. Files are in ${out}.`);
  } finally {
    store.close();
  }
}

try {
  run();
} catch (error) {
  if (!(error instanceof ValidationError) && !(error instanceof TypeError && 'code' in error)) throw error;
  console.error((error as Error).message);
  process.exitCode = 1;
}
