import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { ValidationError } from 'threepoint/core';
import { ConfigurationError, readSoftwareVersion } from 'threepoint-http';
import { checkedPlan, parsePlan, type StudyPlan } from '../../model/plan/plan';
import { exportFiles, exportName, exportZip } from '../../server/export/export-zip';
import { openStudyStore } from '../../server/sqlite/study-store';
import { effectsInWords, simulatedPlan, simulateStudy } from '../../simulation/simulate-study';

const root = fileURLToPath(new URL('../../../..', import.meta.url));
/** The start of the first simulated participant, a fixed day so that the same seed gives the same files. */
const firstSession = Date.UTC(2026, 0, 5, 9) / 1000;

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
  const simulated = simulateStudy(plan, effects, seed, firstSession);

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
    write('SIMULATED-effects.json', `${JSON.stringify({ simulated: true, seed, effects }, null, 2)}\n`);

    console.log(`SIMULATED study of ${simulated.length} participants, ${all.records.length} records, seed ${seed}.`);
    console.log(`Put in: ${effectsInWords(effects)}`);
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
