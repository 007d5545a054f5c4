import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { ValidationError } from 'threepoint/core';
import { ConfigurationError, readSoftwareVersion } from 'threepoint-http';
import { claimOf } from '../../model/plan/hypotheses';
import { checkedPlan, parsePlan, type StudyPlan } from '../../model/plan/plan';
import type { StudyRecord } from '../../model/records/study-record';
import { compareCohorts } from '../../model/results/compare-cohorts';
import { compareConditions } from '../../model/results/compare-conditions';
import { measuresIn, overallComparisons, type StudyMeasures } from '../../model/results/exported-results';
import { exportFiles, exportName, exportZip } from '../../server/export/export-zip';
import { openStudyStore } from '../../server/sqlite/study-store';
import { effectsInWords, modelsWith, simulatedPlan, simulateStudy } from '../../simulation/simulate-study';

const root = fileURLToPath(new URL('../../../..', import.meta.url));
/** The start of the first simulated participant, a fixed day so that the same seed gives the same files. */
const firstSession = Date.UTC(2026, 0, 5, 9) / 1000;

/** The options of the npm script study:simulate. */
interface Options {
  /** The full path of the folder for the files. */
  readonly out: string;
  /** The full path of the plan. */
  readonly plan: string;
  readonly participants?: string;
  readonly seed?: string;
  readonly effect?: readonly string[];
  readonly 'score-effect'?: readonly string[];
}

/** Throws a ValidationError with the name of the option. */
function wholeNumber(name: string, given: string | undefined): number | null {
  if (given === undefined) return null;
  if (!/^\d{1,9}$/.test(given)) throw new ValidationError(`--${name}`, `expected a whole number, not "${given}"`);
  return Number(given);
}

/** Parses "late-200=-0.8"; a number alone belongs to the second condition, or else to the second cohort. */
function effectsIn(plan: StudyPlan, name: string, given: readonly string[] = []): Readonly<Record<string, number>> {
  const { conditions, cohorts = [] } = plan;
  const usual = (conditions[1] ?? cohorts[1])?.id ?? '';
  return Object.fromEntries(
    given.map((one) => {
      const at = one.lastIndexOf('=');
      const value = one.slice(at + 1);
      if (value.trim() === '' || !Number.isFinite(Number(value))) {
        throw new ValidationError(`--${name}`, `expected a number, or a condition and one (id=0.5), not "${one}"`);
      }
      return [at < 0 ? usual : one.slice(0, at), Number(value)];
    }),
  );
}

/** Formats p as "p = 0.0123", never as 0. */
const pText = (p: number | null | undefined) =>
  p != null && p < 0.00005 ? 'p < 0.0001' : `p = ${p?.toFixed(4) ?? 'none'}`;

const signed = (value: number | null | undefined) => value?.toFixed(2).replace('-', '−') ?? 'none';

/** Returns the findings between two cohorts by the mean of all conditions. */
function cohortFindings(
  { answers, points }: StudyMeasures,
  { conditions, cohorts = [] }: StudyPlan,
): readonly string[] {
  const [baseline, other] = cohorts;
  if (!baseline || !other) return [];
  const compared = { sides: [other.id, baseline.id], conditions: conditions.map(({ id }) => id) } as const;
  const lines = [...compareCohorts(answers, compared), ...compareCohorts(points, compared)].map(
    ({ of, test, holmP }) =>
      `  ${of}: t(${test?.df?.toFixed(1)}) = ${signed(test?.t)}, d_s = ${signed(test?.d)}, Holm ${pText(holmP)}`,
  );
  return [`${other.id} − ${baseline.id}, Welch’s t-tests between cohorts, Holm over all questions (scores):`, ...lines];
}

/** Returns what became of each hypothesis of the plan. */
const hypothesisFindings = ({ planned }: StudyMeasures, plan: StudyPlan): readonly string[] =>
  (plan.hypotheses ?? []).flatMap((hypothesis) => {
    const { comparisons } = compareConditions(planned, hypothesis.conditions, plan);
    const own = comparisons.filter((one) => one.hypothesis === hypothesis);
    return [
      `${hypothesis.id}, ${claimOf(hypothesis)}; Holm over the planned measures:`,
      ...own.map(({ of, test, holmP, equivalence, equivalenceHolmP }) => {
        const within = equivalence && `; equivalence t = ${signed(equivalence.t)}, Holm ${pText(equivalenceHolmP)}`;
        return `  ${of.padEnd(4)} difference ${signed(test?.meanDifference)}, t(${test?.df}) = ${signed(test?.t)}, Holm ${pText(holmP)}${within ?? ''}`;
      }),
    ];
  });

/** Returns all findings, line by line. */
function findings(records: readonly StudyRecord[], plan: StudyPlan): readonly string[] {
  const [baseline, other] = plan.conditions;
  const measures = measuresIn(records, plan);
  const lines = [...hypothesisFindings(measures, plan)];
  const all = overallComparisons(measures.answers, plan);
  if (all.length > 0) lines.push('Analyses of variance, Holm over all questions:');
  for (const { of, variance, holmP } of all) {
    const effect = variance?.within ?? variance?.between ?? null;
    lines.push(`  ${of}: F(${effect?.df.join(', ')}) = ${effect?.f?.toFixed(2)}, Holm ${pText(holmP)}`);
  }
  lines.push(...cohortFindings(measures, plan));
  if (!baseline || !other) return lines;
  const { comparisons } = compareConditions(measures.answers, [other.id, baseline.id], plan);
  lines.push(`${other.id} − ${baseline.id}, paired t-tests, Holm over all questions:`);
  for (const { of, test, holmP } of comparisons) {
    const found = test?.t == null ? 'all differences alike' : `t(${test.df}) = ${signed(test.t)}, Holm ${pText(holmP)}`;
    lines.push(`  ${of.padEnd(4)} ${found}`);
  }
  const points = compareConditions(measures.points, [other.id, baseline.id], plan);
  for (const { of, first, second, test } of points.comparisons) {
    const p = test?.p == null ? '' : `, ${pText(test.p)}`;
    const means = `${second?.mean.toFixed(2)} (${baseline.id}) and ${first?.mean.toFixed(2)} (${other.id}) points`;
    lines.push(`  ${of}: ${means}, n = ${first?.n}${p}`);
  }
  return lines;
}

function run(values: Options): void {
  const { out, plan: planFile } = values;
  const participants = wholeNumber('participants', values.participants);
  const givenSeed = wholeNumber('seed', values.seed);
  if (existsSync(out) && readdirSync(out).length > 0) {
    throw new ValidationError('--out', `${out} is not empty. Choose an empty folder for simulated files.`);
  }
  if (!existsSync(planFile)) throw new ValidationError('--plan', `there is no file ${planFile}`);
  const given = parsePlan(readFileSync(planFile, 'utf8'), planFile);
  const seed = givenSeed ?? given.seed;
  const plan = checkedPlan(simulatedPlan({ ...given, seed, ...(participants !== null && { participants }) }));
  const effects = {
    answers: effectsIn(plan, 'effect', values.effect),
    scores: effectsIn(plan, 'score-effect', values['score-effect']),
  };
  const models = modelsWith(plan, effects);
  const simulated = simulateStudy(plan, models, seed, firstSession);

  const write = (path: string, content: string | Uint8Array) => {
    mkdirSync(dirname(join(out, path)), { recursive: true });
    writeFileSync(join(out, path), content);
  };
  mkdirSync(out, { recursive: true });
  const store = openStudyStore(join(out, 'SIMULATED-studies.db'));
  try {
    const { retentionUntil } = store.plans.add(plan, { simulated: true, at: firstSession });
    for (const { participant, records, progress } of simulated) {
      store.places.claim(plan.id, participant, firstSession);
      store.records.store(plan.id, participant, records, records.at(-1)?.at ?? firstSession, 'experimenter');
      store.places.saveProgress(plan.id, participant, progress, firstSession);
    }
    const used = readSoftwareVersion(join(root, 'public'), pathToFileURL(join(root, 'package.json')));
    const software = { exportedBy: used, served: [{ since: firstSession, ...used }] };
    const content = (participant?: string) => {
      const records = store.records.all(plan.id, participant);
      return { plan, simulated: true, records, motion: [], at: firstSession, retentionUntil, software };
    };
    const all = content();
    const name = exportName(all);
    write(`${name}.zip`, exportZip(all));
    for (const [file, text] of Object.entries(exportFiles(all))) write(join(name, file), text);
    for (const { participant } of simulated) {
      const own = content(participant);
      write(join('participants', `${exportName(own, participant)}.zip`), exportZip(own, participant));
    }
    write('SIMULATED-models.json', `${JSON.stringify({ simulated: true, seed, effects, models }, null, 2)}\n`);

    console.log(`SIMULATED study of ${simulated.length} participants, ${all.records.length} records, seed ${seed}.`);
    console.log(`Put in: ${effectsInWords(effects)}`);
    for (const line of findings(all.records, plan)) console.log(line);
    console.log(`Open ${join(out, `${name}.zip`)} on /results: all tables and figures.`);
  } finally {
    store.close();
  }
}

try {
  run(JSON.parse(process.argv[2] ?? '{}'));
} catch (error) {
  if (!(error instanceof ValidationError || error instanceof ConfigurationError)) throw error;
  console.error(error.message);
  process.exitCode = 1;
}
