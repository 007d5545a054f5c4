// Reads files of motion for Python as the page reads them. The request comes as JSON on the standard input. Once the
// numbers of a file lie in the folder `out`, a line of JSON about it goes to the standard output, in the order of the
// request.
import { readFileSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import type { MocapSource } from 'threepoint/internal';
import { reasonOf } from '../../src/threepoint/core/errors/reasons';
import { readSkeletonMap } from '../../src/threepoint/core/mocap/read-skeleton-map';
import { type FileBytes, FileReaderProcess } from './reader-process';

/** A file of motion; `asf`: the skeleton of an AMC file; `rateHz`: its frame rate if a table beside it states one. */
interface MotionPath {
  readonly path: string;
  readonly asf: string | null;
  readonly rateHz: number | null;
}

interface Request {
  readonly files: readonly MotionPath[];
  /** The path of a skeleton map. */
  readonly map: string | null;
  readonly out: string;
}

const textOf = (path: string) => ({ name: basename(path), text: readFileSync(path, 'utf8') });

/** Returns the map and the file that its `restFrame` is of. Throws a sentence where either cannot be read. */
function mapOf(path: string): Pick<MocapSource, 'map' | 'rest'> {
  try {
    const map = textOf(path);
    const { restFile } = readSkeletonMap(map.text, map.name);
    return { map, ...(restFile !== undefined && { rest: textOf(join(dirname(path), restFile)) }) };
  } catch (error) {
    throw new Error(`${basename(path)}: ${reasonOf(error)}`);
  }
}

function fileOf({ path, asf, rateHz }: MotionPath, mapped: Pick<MocapSource, 'map' | 'rest'>): FileBytes {
  const name = basename(path);
  if (/\.amc$/i.test(name) && asf === null) throw new Error('no .asf skeleton beside it');
  const more = { ...mapped, ...(rateHz !== null && { rateHz }), ...(asf !== null && { skeleton: textOf(asf) }) };
  return { name, bytes: new Uint8Array(readFileSync(path)).buffer, ...more };
}

/** What is read of one file; a fault becomes its sentence, and the other files are read. */
async function read(file: MotionPath, i: number, out: string, mapped: Pick<MocapSource, 'map' | 'rest'>) {
  try {
    const { motion, notes, doubts } = await reader.read('truth', fileOf(file, mapped));
    writeFileSync(join(out, `${i}.positions`), motion.positions);
    writeFileSync(join(out, `${i}.rotations`), motion.rotations);
    const rest = Object.fromEntries([...motion.rest].map(([joint, { x, y, z }]) => [joint, [x, y, z]]));
    return { rateHz: motion.rateHz, rest, notes: [...notes, ...doubts] };
  } catch (error) {
    const [name, reason] = [basename(file.path), reasonOf(error)];
    return { refused: reason.startsWith(name) ? reason : `${name}: ${reason}` };
  }
}

using reader = new FileReaderProcess();
const request = JSON.parse(readFileSync(0, 'utf8')) as Request;
try {
  const mapped = request.map === null ? {} : mapOf(request.map);
  for (const [i, file] of request.files.entries())
    console.log(JSON.stringify(await read(file, i, request.out, mapped)));
} catch (error) {
  console.error(reasonOf(error));
  process.exitCode = 1;
}
