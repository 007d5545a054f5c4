import { reasonOf } from 'threepoint/core';
import { drive } from '../drive';
import { loadRegressors } from '../networks';
import { readIndex } from '../recordings';
import { addPiece, emptyGoldenTally, type GoldenFigures, goldenFigures, type StepPlaces } from './golden-figures';
import { type GoldenJob, readPiece, stageOf } from './golden-plan';

/** The argument of a worker, which then asks for one row after another until none is left. */
export interface WorkerTask {
  readonly recordings: string;
  readonly models: string;
}

export interface RowResult {
  readonly row: string;
  readonly figures: GoldenFigures;
  readonly places: StepPlaces;
}

export type WorkerMessage = 'ready' | RowResult;

const { recordings, models } = JSON.parse(process.argv[2] ?? '') as WorkerTask;
const index = readIndex(recordings);
const regressors = await loadRegressors(models);

/** Drives one row of the goldens from beginning to end. */
async function driveRow(job: GoldenJob): Promise<RowResult> {
  const { row, method, pieces } = job;
  const tally = emptyGoldenTally();
  const stage = stageOf(job);
  const regressor = regressors.get(method) ?? null;
  for (const [number, listed] of pieces.entries()) {
    const piece = readPiece(recordings, index, listed);
    const staged = stage(piece, index.rateHz, number);
    const driven = await drive(method, staged.calibration, regressor, staged.frames);
    const seen = staged.losses.length > 0 ? await drive(method, piece.calibration, regressor, piece.frames) : null;
    addPiece(tally, { name: piece.name, recordedHz: index.rateHz, staged, driven, seen });
  }
  return { row, ...goldenFigures(tally) };
}

const send = (message: WorkerMessage) => process.send?.(message);
process.on('message', ({ job }: { readonly job: GoldenJob | null }) => {
  if (!job) {
    process.disconnect();
    return;
  }
  driveRow(job).then(send, (error: unknown) => {
    console.error(`${job.row}: ${reasonOf(error)}`);
    process.exit(1);
  });
});
send('ready');
