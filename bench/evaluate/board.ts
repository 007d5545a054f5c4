import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { type Calibration, reasonOf, recordOf, skeletonFromCalibration } from 'threepoint/core';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import { Pipeline } from '../../src/threepoint/core/estimation/pipeline';
import { type BoardMethod, boardMethods, fieldNetworks, startFieldNetwork } from '../board-methods';
import { createCcdBody } from '../page/ccd-body';
import { lasting, loseHands, scheduleLosses, seedOf } from './disturbances';
import { createDriver, type DrawnFrame, type Driver, driveFrames, pipelineDriver } from './drive';
import { addLosses, emptyLossTally, reportLosses } from './losses';
import { addClip, emptyMeasures, report } from './measures';
import { loadRegressors } from './networks';
import { calibrationOf, peopleOf, type RecordingIndex, readClip, readIndex } from './recordings';
import { chooseClips } from './robustness';
import { createWindowSource } from './window-source';

const options = JSON.parse(process.argv[2] ?? '') as Readonly<
  Record<'recordings' | 'networks' | 'seed' | 'json', string> & { elsewhere: readonly string[]; frames: number }
>;

/** Two seconds, as in docs/accuracy.md: the same clip has the same losses there. */
const lossSeconds = 2;

type Drivers = (method: BoardMethod, calibration: Calibration) => Driver<DrawnFrame>;

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

/** Starts every network of the board. */
async function openDrivers(): Promise<Drivers> {
  const ours = await loadRegressors(options.networks);
  const field = new Map<string, PoseRegressor>();
  for (const name of fieldNetworks) {
    const bytes = readFileSync(join(options.networks, `${name}-${options.seed}.onnx`));
    field.set(name, await startFieldNetwork(ours.get('learned')!.contract, bytes));
  }
  return (method, calibration) => {
    if (method === 'ccd') return ccdDriver(calibration);
    const regressor = field.get(method);
    if (regressor)
      return pipelineDriver(
        method,
        new Pipeline('learned', calibration, createWindowSource(calibration, regressor)),
        calibration,
      );
    const name = method as 'ik' | 'paper' | 'learned';
    return createDriver(name, calibration, name === 'ik' ? null : ours.get(name)!);
  };
}

/** Measures every method on some of these clips, undisturbed and with lost hands. */
async function measureClips(index: RecordingIndex, clips: RecordingIndex['clips'], drivers: Drivers) {
  const chosen = chooseClips(clips, options.frames);
  const measures = recordOf(boardMethods, emptyMeasures);
  const tallies = recordOf(boardMethods, emptyLossTally);
  for (const clip of chosen) {
    const calibration = calibrationOf(index, clip);
    const frames = readClip(options.recordings, index, clip);
    const seed = seedOf(`${clip.name} ${lossSeconds}`);
    const losses = scheduleLosses(frames.length, index.rateHz, lasting(lossSeconds), seed);
    for (const method of boardMethods) {
      const seen = await driveFrames(drivers(method, calibration), frames);
      addClip(measures[method], seen, index.rateHz);
      if (losses.length === 0) continue;
      const lossy = await driveFrames(drivers(method, calibration), loseHands(frames, losses));
      addLosses(tallies[method], { lossy, seen }, losses, index.rateHz);
    }
    console.log(`  ${clip.name}`);
  }
  return {
    people: peopleOf(chosen),
    clips: chosen.length,
    frames: chosen.reduce((sum, { frames }) => sum + frames, 0),
    methods: recordOf(boardMethods, (method) => ({
      ...report(measures[method]),
      loss: reportLosses(tallies[method]),
    })),
  };
}

async function main(): Promise<void> {
  const index = readIndex(options.recordings);
  const drivers = await openDrivers();
  const isElsewhere = ({ person }: { readonly person: string }) => options.elsewhere.includes(person);
  const heldOut = await measureClips(
    index,
    index.clips.filter((clip) => !isElsewhere(clip)),
    drivers,
  );
  const others = index.clips.filter(isElsewhere);
  const elsewhere = others.length > 0 ? await measureClips(index, others, drivers) : null;
  writeFileSync(options.json, `${JSON.stringify({ heldOut, elsewhere })}\n`);
  for (const method of boardMethods)
    console.log(`${method}: MPJPE ${heldOut.methods[method].mpjpeCm.mean.toFixed(2)} cm`);
}

await main().catch((error: unknown) => {
  console.error(reasonOf(error));
  process.exitCode = 1;
});
