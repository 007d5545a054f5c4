import { writeFileSync } from 'node:fs';
import { reasonOf, recordOf } from 'threepoint/core';
import { doubtOfErrors } from 'threepoint/internal';
import { readCheckFile, trackingOf } from './checked-headset';
import { type DeviceTracking, usualTracking } from './disturbances';
import { drive, type MeasuredMethod, measuredMethods } from './drive';
import { addPictures, inOrder, type Pictures } from './figures';
import { addClip, emptyMeasures, type MeasuredFrame, type Measures, merge, type Report, report } from './measures';
import { loadRegressors } from './networks';
import { calibrationOf, peopleOf, type RecordingIndex, readClip, readIndex } from './recordings';
import { printReports } from './report-text';
import { chooseClips, measureRobustness, robustnessText } from './robustness';
import { addSpeeds, emptySpeedTally, type SpeedTally, speedTable } from './speed';

/** Robustness drives forty variants of each clip: beyond so many frames, a selection stands for the rest. */
const robustnessFrames = 12_000;

const options = JSON.parse(process.argv[2] ?? '') as Readonly<
  Record<'recordings' | 'models', string> &
    Partial<Record<'json' | 'noise' | 'figures' | 'fp32', string>> &
    Partial<Record<'robustness' | 'speed' | 'hands-measured' | 'forearm-typed', boolean>>
>;

/** Returns the calibration of a clip: eye height and span, and on request hand tilts and forearm. */
const clipCalibration = (index: RecordingIndex, clip: RecordingIndex['clips'][number]) =>
  calibrationOf(index, clip, { hands: options['hands-measured'], forearm: options['forearm-typed'] });

/** The methods whose disturbances and speeds docs/accuracy.md has. */
const disturbedMethods = ['ik', 'learned'] as const satisfies readonly MeasuredMethod[];

type Exact = Partial<Record<MeasuredMethod, Report>>;

/** The share of the work that is done, on a terminal only; nothing remains of it at the end. */
function progress(share: number, what = 'robustness'): void {
  if (!process.stderr.isTTY) return;
  process.stderr.write(share < 1 ? `\r  ${what} ${Math.round(100 * share)} %   ` : '\r\x1b[K');
}

/** The recordings, networks and people of an evaluation. */
interface Corpus {
  readonly recordings: string;
  readonly index: ReturnType<typeof readIndex>;
  readonly regressors: Awaited<ReturnType<typeof loadRegressors>>;
  /** The networks before quantisation; null: not requested. */
  readonly exactRegressors: Awaited<ReturnType<typeof loadRegressors>> | null;
  readonly people: readonly string[];
  /** People that a network was trained on. */
  readonly seen: ReadonlySet<string>;
  readonly unseen: readonly string[];
  /** The clips that are shown and compared: of people never trained on, if there are any. */
  readonly judged: RecordingIndex['clips'];
}

async function readCorpus(recordings: string, models: string, fp32: string | undefined): Promise<Corpus> {
  const index = readIndex(recordings);
  const regressors = await loadRegressors(models);
  const seen = new Set([...regressors.values()].flatMap(({ contract }) => contract.trainedOn.people));
  const people = peopleOf(index.clips);
  const exactRegressors = fp32 ? await loadRegressors(fp32) : null;
  const unseen = people.filter((person) => !seen.has(person));
  const judged = index.clips.filter(({ person }) => unseen.length === 0 || !seen.has(person));
  return { recordings, index, regressors, exactRegressors, people, seen, unseen, judged };
}

interface Measured {
  readonly byPerson: ReadonlyMap<string, Record<MeasuredMethod, Measures>>;
  readonly exact: ReadonlyMap<MeasuredMethod, Measures>;
  readonly pictures: Pictures;
  readonly frames: number;
}

/** Drives every method through every clip. */
async function measureClips(corpus: Corpus): Promise<Measured> {
  const { recordings, index, regressors, exactRegressors, judged } = corpus;
  const byPerson = new Map<string, Record<MeasuredMethod, Measures>>();
  const exact = new Map<MeasuredMethod, Measures>();
  const pictures: Pictures = new Map();
  const total = index.clips.reduce((sum, clip) => sum + clip.frames, 0);
  let done = 0;
  for (const clip of index.clips) {
    const calibration = clipCalibration(index, clip);
    const person = byPerson.get(clip.person) ?? recordOf(measuredMethods, emptyMeasures);
    byPerson.set(clip.person, person);
    const frames = readClip(recordings, index, clip);
    const driven = {} as Record<MeasuredMethod, MeasuredFrame[]>;
    for (const name of measuredMethods) {
      driven[name] = await drive(name, calibration, regressors.get(name) ?? null, frames);
      addClip(person[name], driven[name], index.rateHz);
    }
    if (judged.includes(clip)) {
      if (options.figures) addPictures(pictures, clip.name, driven, index.rateHz);
      for (const [name, regressor] of exactRegressors ?? []) {
        const measures = exact.get(name) ?? emptyMeasures();
        addClip(measures, await drive(name, calibration, regressor, frames), index.rateHz);
        exact.set(name, measures);
      }
    }
    done += clip.frames;
    progress(done / total, clip.name);
  }
  return { byPerson, exact, pictures, frames: total };
}

/** The measures as reports, of everyone, of those never trained on and of each person. */
function resultOf({ index, people, seen, unseen }: Corpus, { byPerson, exact, frames }: Measured) {
  const over = (who: readonly string[]): Record<MeasuredMethod, Report> =>
    recordOf(measuredMethods, (name) => report(merge(who.flatMap((person) => byPerson.get(person)?.[name] ?? []))));
  return {
    corpus: {
      clips: index.clips.length,
      people: people.length,
      frames,
      seconds: Number((frames / index.rateHz).toFixed(1)),
    },
    estimators: over(people),
    ...(unseen.length > 0 && unseen.length < people.length
      ? { unseen: over(unseen), seen: over(people.filter((person) => seen.has(person))) }
      : {}),
    people: Object.fromEntries(people.map((person) => [person, { seen: seen.has(person), ...over([person]) }])),
    ...(exact.size > 0
      ? { fp32: Object.fromEntries([...exact].map(([name, measures]) => [name, report(measures)])) as Exact }
      : {}),
    problems: index.problems,
  };
}

function printResult({ index, people, seen, unseen }: Corpus, result: ReturnType<typeof resultOf>): void {
  console.log(
    `\n${result.corpus.clips} clips, ${result.corpus.people} people, ${(result.corpus.seconds / 60).toFixed(1)} minutes at ${index.rateHz} Hz`,
  );
  for (const problem of index.problems) console.log(`  ${problem}`);
  const named = people.map((person) => (seen.has(person) ? `${person} (seen)` : person)).join(', ');
  printReports(`All: ${named}`, result.estimators);
  if (result.unseen) printReports(`Never trained on: ${unseen.join(', ')}`, result.unseen);
  for (const person of people) {
    const own = result.people[person];
    if (own && people.length > 1) {
      const row = measuredMethods.map((name) => `${name} ${own[name].mpjpeCm.mean.toFixed(2)}`).join('   ');
      console.log(`  ${person}${own.seen ? ' (seen)' : ''}: MPJPE [cm]  ${row}`);
    }
    const doubt = own && doubtOfErrors(measuredMethods.map((name) => own[name].mpjpeCm.mean));
    if (doubt) console.log(`  ${person}: ${doubt}`);
  }
  for (const [name, { mpjpeCm, jerkRatio }] of Object.entries(result.fp32 ?? {}) as [MeasuredMethod, Report][]) {
    const int8 = (result.unseen ?? result.estimators)[name];
    console.log(
      `  ${name}: int8 ${int8.mpjpeCm.mean.toFixed(3)} cm, jerk ${int8.jerkRatio.toFixed(3)} ×; ` +
        `fp32 ${mpjpeCm.mean.toFixed(3)} cm, ${jerkRatio.toFixed(3)} ×`,
    );
  }
}

/** The judged clips again, each with one thing wrong; `tracking`: the device whose noise and losses they have. */
function measureDisturbed({ recordings, index, regressors, judged }: Corpus, tracking: DeviceTracking) {
  return measureRobustness({
    methods: disturbedMethods,
    clips: chooseClips(judged, robustnessFrames),
    load: (clip) => ({
      name: clip.name,
      calibration: clipCalibration(index, clip),
      frames: readClip(recordings, index, clip),
    }),
    regressors,
    rateHz: index.rateHz,
    tracking,
    onProgress: progress,
  });
}

/** The judged clips by speed, on the shipping path and frame by frame. */
async function measureSpeeds({ recordings, index, regressors, judged }: Corpus) {
  const tallies: Partial<Record<MeasuredMethod, SpeedTally>> = {};
  for (const clip of judged) {
    const calibration = clipCalibration(index, clip);
    const frames = readClip(recordings, index, clip);
    for (const name of disturbedMethods) {
      tallies[name] ??= emptySpeedTally();
      const regressor = regressors.get(name) ?? null;
      await addSpeeds(tallies[name], name, { calibration, regressor, frames, rateHz: index.rateHz });
    }
  }
  return tallies;
}

async function main(): Promise<void> {
  const { recordings, models, json, robustness, noise, figures, fp32 } = options;
  // A file with a fault is refused before minutes of work.
  const checked = noise ? trackingOf(readCheckFile(noise), noise) : null;
  for (const remark of checked?.remarks ?? []) console.log(remark);
  const corpus = await readCorpus(recordings, models, fp32);
  const measured = await measureClips(corpus);
  const result = resultOf(corpus, measured);
  printResult(corpus, result);
  const { rateHz } = corpus.index;
  if (figures) writeFileSync(figures, `${JSON.stringify({ poses: inOrder(measured.pictures) })}\n`);
  const disturbed = robustness || checked ? await measureDisturbed(corpus, checked ?? usualTracking) : null;
  if (disturbed) console.log(robustnessText(disturbed, rateHz));
  const speeds = options.speed ? await measureSpeeds(corpus) : null;
  if (speeds) console.log(speedTable(speeds));
  const complete = { ...result, ...(speeds ? { speeds } : {}), ...(disturbed ? { robustness: disturbed } : {}) };
  if (json) writeFileSync(json, `${JSON.stringify(complete, null, 2)}\n`);
}

await main().catch((error: unknown) => {
  console.error(reasonOf(error));
  process.exitCode = 1;
});
