import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { reasonOf, recordOf } from 'threepoint/core';
import { LegPosture } from '../../../src/threepoint/avatar/legs/leg-posture';
import { Gait, type GaitNetwork } from '../../../src/threepoint/core/estimation/gait/gait';
import { shippedGait } from '../../../src/threepoint/core/estimation/gait/shipped-gait';
import { loadRegressors } from '../networks';
import { peopleOf, readIndex } from '../recordings';
import { bodyOf, driveLegs, type LegDriver, legDrivers, mannequinLegs } from './leg-drivers';
import { addLegs, emptyLegMeasures, type LegReport, legReport, meanReport } from './leg-measures';

/**
 * The network of each person: the page's where it has not seen them; else one of the folder that has not, where there
 * is one.
 */
function gaitsOf(folder: string | undefined): (person: string) => GaitNetwork {
  const held = folder
    ? readdirSync(folder)
        .filter((name) => name.endsWith('.json'))
        .sort()
    : [];
  const networks = held.map((name) => JSON.parse(readFileSync(join(folder!, name), 'utf8')) as GaitNetwork);
  return (person) => [shippedGait, ...networks].find(({ trainedOn }) => !trainedOn.includes(person)) ?? shippedGait;
}

interface PersonLegs extends Record<LegDriver, LegReport> {
  /** Whether the body's network, and the gait network, were trained on this person. */
  readonly seen: boolean;
  readonly gaitSeen: boolean;
  readonly minutes: number;
}

async function main(): Promise<void> {
  const { recordings, models, json, gaits } = JSON.parse(process.argv[2] ?? '') as Record<
    'recordings' | 'models',
    string
  > &
    Partial<Record<'json' | 'gaits', string>>;
  const index = readIndex(recordings);
  const learned = (await loadRegressors(models)).get('learned') ?? null;
  const seen = new Set(learned?.contract.trainedOn.people);
  const gaitOf = gaitsOf(gaits);
  const legsOf = await mannequinLegs();
  const people: Record<string, PersonLegs> = {};
  for (const person of peopleOf(index.clips)) {
    const measures = recordOf(legDrivers, emptyLegMeasures);
    const clips = await driveLegs(recordings, index, person, learned);
    const network = gaitOf(person);
    for (const clip of clips) {
      const proportions = legsOf(clip.calibration);
      for (const driver of legDrivers) {
        const posture = new LegPosture(proportions, clip.calibration.eyeHeight, new Gait(network));
        addLegs(measures[driver], bodyOf(clip, driver, index.rateHz), posture, proportions);
      }
    }
    const frames = clips.reduce((sum, { truth }) => sum + truth.length, 0);
    if (frames === 0) console.log(`${person}: no legs with toes in these recordings`);
    else
      people[person] = {
        seen: seen.has(person),
        gaitSeen: network.trainedOn.includes(person),
        minutes: frames / index.rateHz / 60,
        ...recordOf(legDrivers, (driver) => legReport(measures[driver])),
      };
  }
  const reports = Object.entries(people);
  if (reports.length === 0) throw new Error('legs: none of these recordings has legs with toes');
  for (const problem of index.problems) console.log(`  ${problem}`);
  for (const driver of legDrivers) {
    const all = meanReport(reports.map(([, report]) => report[driver]));
    console.log(`\nLegs under the hips of: ${driver}`);
    const rows = reports.map(([name, report]) => [name, report[driver]] as const);
    console.table(Object.fromEntries([...rows, ['all alike', all]]));
  }
  if (json) writeFileSync(json, `${JSON.stringify({ people, problems: index.problems }, null, 2)}\n`);
}

await main().catch((error: unknown) => {
  console.error(reasonOf(error));
  process.exitCode = 1;
});
