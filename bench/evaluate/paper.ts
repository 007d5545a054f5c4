import { writeFileSync } from 'node:fs';
import { reasonOf, recordOf } from 'threepoint/core';
import { mean } from '../../src/threepoint/core/math/statistics';
import { type DrivenMethod, drive } from './drive';
import { addPictures, inOrder, type Pictures } from './figures';
import { addClip, emptyMeasures, report, rounded } from './measures';
import { loadRegressors } from './networks';
import { calibrationOf, readClip, readIndex } from './recordings';
import { chooseClips } from './robustness';

/** The methods of docs/paper.md: the baseline, and the paper's network with our fit and with its own orientations. */
const methods = ['ik', 'paper', 'paper-published'] as const satisfies readonly DrivenMethod[];
/** The frames of the paper's tables 5 and 6. */
const paperFrames = [6736, 8661] as const;

const options = JSON.parse(process.argv[2] ?? '') as Readonly<Record<'recordings' | 'models' | 'json', string>>;

/** Returns the least, the longest and the mean time [ms]. */
const spreadOf = (milliseconds: readonly number[]) => ({
  frames: milliseconds.length,
  minimum: rounded(Math.min(...milliseconds), 3),
  maximum: rounded(Math.max(...milliseconds), 3),
  average: rounded(mean(milliseconds), 3),
});

/** Drives every method over as many clips as the frames of the paper's tables 5 and 6 allow. */
async function main(): Promise<void> {
  const { recordings, models, json } = options;
  const index = readIndex(recordings);
  const network = (await loadRegressors(models)).get('paper') ?? null;
  const chosen = chooseClips(index.clips, paperFrames[0] + paperFrames[1]);
  const measures = recordOf(methods, emptyMeasures);
  const times = recordOf(methods, (): number[] => []);
  const pictures: Pictures = new Map();
  for (const clip of chosen) {
    const frames = readClip(recordings, index, clip);
    const calibration = calibrationOf(index, clip);
    const driven = {
      ik: await drive('ik', calibration, null, frames),
      paper: await drive('paper', calibration, network, frames),
      'paper-published': await drive('paper-published', calibration, network, frames),
    };
    for (const name of methods) {
      addClip(measures[name], driven[name], index.rateHz);
      times[name].push(...driven[name].map(({ cpuMilliseconds }) => cpuMilliseconds));
    }
    addPictures(pictures, clip.name, driven, index.rateHz);
  }
  const { trainedOn } = network!.contract;
  const result = {
    people: [...new Set(chosen.map(({ person }) => person))].sort(),
    seen: chosen.some(({ person }) => trainedOn.people.includes(person)),
    frames: chosen.reduce((sum, { frames }) => sum + frames, 0),
    methods: recordOf(methods, (name) => ({
      ...report(measures[name]),
      times: [times[name].slice(0, paperFrames[0]), times[name].slice(paperFrames[0])]
        .filter((part) => part.length > 0)
        .map(spreadOf),
    })),
    poses: inOrder(pictures),
  };
  writeFileSync(json, `${JSON.stringify(result)}\n`);
  for (const name of methods) console.log(`${name}: MPJPE ${result.methods[name].mpjpeCm.mean.toFixed(2)} cm`);
}

await main().catch((error: unknown) => {
  console.error(reasonOf(error));
  process.exitCode = 1;
});
