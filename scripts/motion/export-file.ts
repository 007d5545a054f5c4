import {
  closeSync,
  existsSync,
  fsyncSync,
  openSync,
  readFileSync,
  renameSync,
  rmSync,
  statSync,
  writeFileSync,
} from 'node:fs';
import { basename, dirname, extname, join } from 'node:path';
import { type EstimatorName, estimatorNames, parseRecording, type Replayable, reasonOf } from 'threepoint/core';
import { isGltfMotion } from 'threepoint/files';
import { type MotionFormat, type MotionWriter, motionFormats, type WorkOptions } from 'threepoint/motion';
import { recordingOf } from '../../src/page/mocap/simulated-recording';
import { isTable, purposeOfTable } from '../../src/page/mocap/table-files';
import { writeMotionFile } from '../../src/threepoint/api/write-motion-file';
import { createAvatarMotionWriter } from '../../src/threepoint/avatar/avatar-motion-writer';
import type { NetworkName } from '../../src/threepoint/core/estimation/estimators';
import { createPlainRegressor } from '../../src/threepoint/core/estimation/networks/learned-network';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import { startRegressor } from '../../src/threepoint/onnx/load-regressor';
import { parseContract } from '../../src/threepoint/onnx/model-contract';
import { FileReaderProcess } from './reader-process';

/** The options of the command line, with absolute paths. */
export interface MotionRequest {
  readonly file: string;
  readonly to: string;
  readonly estimator?: string;
  readonly out?: string;
  readonly unit?: string;
  readonly rate?: string;
  readonly avatar?: string;
}

const root = join(import.meta.dirname, '../..');

/** Loads the page's networks from their files: the learned one without a runtime, the paper's by onnxruntime-web. */
async function network(name: NetworkName): Promise<PoseRegressor> {
  const folder = join(root, 'public/models');
  const contract = parseContract(`${name}.json`, readFileSync(join(folder, `${name}.json`), 'utf8'));
  const bytes = (file: string) => readFileSync(join(folder, file));
  return contract.weights
    ? createPlainRegressor(contract, bytes(contract.weights.file))
    : startRegressor(contract, bytes(contract.file));
}

function readGiven(path: string, what: string): Buffer {
  if (!existsSync(path)) throw new Error(`${what}: there is no file ${path}`);
  try {
    return readFileSync(path);
  } catch (error) {
    throw new Error(`${what}: ${path} cannot be read (${reasonOf(error)})`);
  }
}

async function formatOf({ to, avatar }: MotionRequest): Promise<MotionFormat | MotionWriter> {
  const format = checked('--to', to, [...motionFormats, 'glb']);
  if (format !== 'glb') {
    if (avatar) throw new Error('--avatar is for --to glb alone');
    return format;
  }
  const path = avatar ?? join(root, 'public/avatars/mannequin.vrm');
  const file = readGiven(path, '--avatar');
  return createAvatarMotionWriter(await readApart('avatar', path, file), basename(path));
}

function checked<Name extends string>(option: string, value: string, names: readonly Name[]): Name {
  const found = names.find((name) => name === value);
  if (!found) throw new Error(`${option}: “${value}” is none of ${names.join(', ')}`);
  return found;
}

function rateOf(rate: string | undefined): { rateHz?: number } {
  if (rate === undefined) return {};
  const rateHz = Number(rate);
  if (!(rateHz >= 1 && rateHz <= 1000)) throw new Error(`--rate: “${rate}” is no rate from 1 to 1000 Hz`);
  return { rateHz };
}

/** Reads a file in a process of limited memory, which ends afterwards. */
async function readApart<Call extends 'clips' | 'avatar'>(call: Call, path: string, bytes: Uint8Array) {
  using reader = new FileReaderProcess();
  return await reader.read(call, { name: basename(path), bytes: new Uint8Array(bytes).buffer });
}

/** Reads motion capture as the page does: what a headset and two hands would have recorded of its longest piece. */
async function simulatedRecording(path: string, bytes: Uint8Array): Promise<Replayable> {
  const clips = await readApart('clips', path, bytes);
  return recordingOf(clips.reduce((longest, clip) => (clip.frameCount > longest.frameCount ? clip : longest)));
}

const isMocap = (path: string): boolean => /\.bvh$/i.test(path) || isGltfMotion(path);

/** Reads a recording of the page, or motion capture. */
async function recordingIn(path: string): Promise<Replayable> {
  const bytes = readGiven(path, 'motion');
  try {
    if (isTable(path)) throw new Error(purposeOfTable(bytes.toString('utf8')));
    return isMocap(path) ? await simulatedRecording(path, bytes) : parseRecording(bytes.toString('utf8'));
  } catch (error) {
    const reason = reasonOf(error);
    throw new Error(reason.startsWith(basename(path)) ? reason : `${basename(path)}: ${reason}`);
  }
}

/** Whether two paths lead to the same file, by whatever names of folders and links. */
function isSameFile(path: string, other: string): boolean {
  const [one, two] = [path, other].map((each) => statSync(each, { bigint: true, throwIfNoEntry: false }));
  return one !== undefined && one.dev === two?.dev && one.ino === two.ino;
}

/**
 * Writes a file atomically: to a temporary file in the same folder, which is then renamed. Throws errors of the file
 * system.
 */
export function writeWhole(path: string, parts: Iterable<string | Uint8Array>): void {
  const temporary = join(dirname(path), `.${basename(path)}.${process.pid}.part`);
  const file = openSync(temporary, 'wx');
  try {
    try {
      for (const part of parts) writeFileSync(file, part);
      fsyncSync(file);
    } finally {
      closeSync(file);
    }
    renameSync(temporary, path);
  } catch (error) {
    rmSync(temporary, { force: true });
    throw error;
  }
}

/**
 * Reads a recording or motion capture and writes the exported file atomically; resolves to its path. Rejects with a
 * message if the recording, the avatar or an option is wrong, and with the signal's reason if it is aborted.
 */
export async function exportFile(request: MotionRequest, work: WorkOptions = {}): Promise<string> {
  const { file, unit = 'm', rate, estimator = 'learned' } = request;
  const name: EstimatorName = checked('--estimator', estimator, estimatorNames);
  const options = { unit: checked('--unit', unit, ['m', 'cm']), ...rateOf(rate) };
  const to = await formatOf(request);
  const recording = await recordingIn(file);
  const made = await writeMotionFile(recording, {
    ...options,
    ...work,
    format: to,
    estimator: name,
    networks: network,
  });
  const stem = `${basename(file, extname(file))}-${name}${options.unit === 'cm' ? '-cm' : ''}`;
  const out = request.out ?? join(dirname(file), `${stem}.${made.extension}`);
  const source = [file, request.avatar].find((given) => given && isSameFile(out, given));
  if (source) throw new Error(`${source} would be overwritten; give another file by --out`);
  work.signal?.throwIfAborted();
  try {
    writeWhole(out, made.parts);
  } catch (error) {
    throw new Error(`${out} could not be written (${reasonOf(error)}): nothing is there that was not before`);
  }
  return out;
}
