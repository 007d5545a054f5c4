import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { type Calibration, reasonOf, skeletonFromCalibration } from 'threepoint/core';
import { type BoardMethod, isFieldNetwork, startFieldNetwork } from '../board-methods';
import { createCcdBody } from '../page/ccd-body';
import { lasting, loseHands, scheduleLosses, seedOf } from './disturbances';
import { createDriver, type DrawnFrame, type Driver, driveFrames, pipelineDriver } from './drive';
import { addLosses, emptyLossTally, reportLosses } from './losses';
import { addClip, emptyMeasures, report } from './measures';
import { loadRegressors } from './networks';
import { calibrationOf, peopleOf, type RecordingIndex, readClip, readIndex } from './recordings';
import { chooseClips } from './robustness';
import { createWithWindows } from './window-source';

const { recordings, networks, method, json, elsewhere, frames } = JSON.parse(process.argv[2] ?? '') as Readonly<
  Record<'recordings' | 'networks' | 'json', string> & {
    method: BoardMethod;
    elsewhere: readonly string[];
    frames: number;
  }
>;

/** Two seconds, as in docs/accuracy.md: the same clip has the same losses there. */
const lossSeconds = 2;

/** Drives three's solver. */
function ccdDriver(calibration: Calibration): Driver<DrawnFrame> {
  const skeleton = skeletonFromCalibration(calibration);
  let body = createCcdBody(skeleton);
  return {
    async draw(frame) {
      body.solve(frame);
      return { joints: body.joints(), raw: null };
    },
    reset() {
      body = createCcdBody(skeleton);
    },
  };
}

/** Starts the method; resolves to what drives it for the person of a clip. */
async function openMethod(): Promise<(calibration: Calibration) => Driver<DrawnFrame>> {
  if (method === 'ccd') return ccdDriver;
  const ours = await loadRegressors(networks);
  if (!isFieldNetwork(method)) {
    return (calibration) => createDriver(method, calibration, ours.get(method) ?? null);
  }
  const bytes = readFileSync(join(networks, `${method}.onnx`));
  const regressor = await startFieldNetwork(ours.get('learned')!.contract, bytes);
  return (calibration) => pipelineDriver(method, createWithWindows(calibration, regressor), calibration);
}

/** Measures the method on some of these clips, undisturbed and with lost hands. */
async function measureClips(
  index: RecordingIndex,
  clips: RecordingIndex['clips'],
  driverOf: (calibration: Calibration) => Driver<DrawnFrame>,
) {
  const chosen = chooseClips(clips, frames);
  const measures = emptyMeasures();
  const tally = emptyLossTally();
  for (const clip of chosen) {
    const calibration = calibrationOf(index, clip);
    const recorded = readClip(recordings, index, clip);
    const seen = await driveFrames(driverOf(calibration), recorded);
    addClip(measures, seen, index.rateHz);
    const lengths = seedOf(`${clip.name} ${lossSeconds}`);
    const losses = scheduleLosses(recorded.length, index.rateHz, lasting(lossSeconds), lengths);
    if (losses.length === 0) continue;
    const lossy = await driveFrames(driverOf(calibration), loseHands(recorded, losses));
    addLosses(tally, { lossy, seen }, losses, index.rateHz);
  }
  return {
    people: peopleOf(chosen),
    clips: chosen.length,
    frames: chosen.reduce((sum, clip) => sum + clip.frames, 0),
    ...report(measures),
    loss: tally.losses > 0 ? reportLosses(tally) : null,
  };
}

async function main(): Promise<void> {
  const index = readIndex(recordings);
  const driverOf = await openMethod();
  const isElsewhere = ({ person }: RecordingIndex['clips'][number]) => elsewhere.includes(person);
  const heldOut = await measureClips(
    index,
    index.clips.filter((clip) => !isElsewhere(clip)),
    driverOf,
  );
  const clips = index.clips.filter(isElsewhere);
  const others = clips.length > 0 ? await measureClips(index, clips, driverOf) : null;
  writeFileSync(json, `${JSON.stringify({ heldOut, elsewhere: others })}\n`);
  console.log(`${method}: MPJPE ${heldOut.mpjpeCm.mean.toFixed(2)} cm`);
}

await main().catch((error: unknown) => {
  console.error(reasonOf(error));
  process.exitCode = 1;
});
