import { reasonOf } from 'threepoint/core';
import { createDriver, type MeasuredMethod } from '../drive';
import type { MeasuredFrame } from '../measures';
import { loadRegressors } from '../networks';
import { type RecordingIndex, readIndex } from '../recordings';
import { onTruthsFloor, type Staged, undisturbed } from '../situations';
import { addPiece, emptyGoldenTally, type GoldenFigures, goldenFigures, type StepPlaces } from './golden-figures';
import { type KeptFrames, keepFrames } from './golden-frames';
import { type Extent, type GoldenJob, planGoldens, readPiece, stageOf } from './golden-plan';

/** The first message to a worker, which then requests rows by name until none is left. */
export interface WorkerTask {
  readonly recordings: string;
  readonly models: string;
  readonly extent: Extent;
}

export interface RowResult {
  readonly row: string;
  readonly figures: GoldenFigures;
  readonly places: StepPlaces;
  readonly kept: readonly KeptFrames[];
}

export type WorkerMessage = 'ready' | RowResult;

type Regressors = Awaited<ReturnType<typeof loadRegressors>>;

/** Drives one row of the goldens from beginning to end. */
export async function driveRow(
  job: GoldenJob,
  folder: string,
  index: RecordingIndex,
  regressors: Regressors,
): Promise<RowResult> {
  const tally = emptyGoldenTally();
  const kept: KeptFrames[] = [];
  const stage = stageOf(job);
  for (const [number, listed] of job.pieces.entries()) {
    const piece = readPiece(folder, index, listed);
    const staged = stage(piece, index.rateHz, number);
    const driven = await driveStaged(job.method, staged, regressors);
    const seen =
      staged.losses.length > 0
        ? await driveStaged(job.method, undisturbed(piece, index.rateHz, number), regressors)
        : null;
    const { rateHz, frames, losses } = staged;
    addPiece(tally, { name: piece.name, rateHz, recordedHz: index.rateHz, staged: frames, driven, losses, seen });
    const times = frames.map(({ frame }) => frame.time);
    kept.push(keepFrames(piece.name, driven, times));
  }
  return { row: job.row, ...goldenFigures(tally), kept };
}

/** Drives what was staged; joints and wrists come back on the floor of the truth. */
export async function driveStaged(
  method: MeasuredMethod,
  staged: Staged,
  regressors: Regressors,
): Promise<MeasuredFrame[]> {
  const driver = createDriver(method, staged.calibration, regressors.get(method) ?? null);
  const result: MeasuredFrame[] = [];
  for (const stagedFrame of staged.frames) {
    if (stagedFrame.reset) driver.reset();
    const drawn = await driver.draw(stagedFrame.frame);
    const { leftHand, rightHand } = stagedFrame.frame;
    const seen = { ...(leftHand && { left: leftHand.position }), ...(rightHand && { right: rightHand.position }) };
    const wrists = onTruthsFloor(seen, stagedFrame);
    result.push({
      joints: onTruthsFloor(drawn.joints, stagedFrame),
      truth: stagedFrame.truth,
      raw: null,
      wrists: { left: wrists.left ?? null, right: wrists.right ?? null },
    });
  }
  return result;
}

async function work({ recordings, models, extent }: WorkerTask): Promise<void> {
  const index = readIndex(recordings);
  const regressors = await loadRegressors(models);
  const trainedOn = new Set([...regressors.values()].flatMap(({ contract }) => contract.trainedOn.people));
  const jobs = new Map(planGoldens(index, trainedOn, extent).map((job) => [job.row, job]));
  const send = (message: WorkerMessage) => process.send?.(message);
  process.on('message', ({ row }: { readonly row: string | null }) => {
    const job = row === null ? null : jobs.get(row);
    if (!job) {
      process.disconnect();
      return;
    }
    driveRow(job, recordings, index, regressors).then(send, (error: unknown) => {
      console.error(`${job.row}: ${reasonOf(error)}`);
      process.exit(1);
    });
  });
  send('ready');
}

// Only as the program of a child process: tests import what is above.
if (process.send && process.argv[1]?.endsWith('golden-worker.ts')) {
  await work(JSON.parse(process.argv[2] ?? '{}') as WorkerTask);
}
