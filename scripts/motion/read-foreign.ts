// Reads files of motion for Python as the page reads them. The request comes as JSON on the standard input: `files`,
// `map` (a skeleton map or null) and the folder `out`, to which `index.json` and the numbers of every file are written.
import { readFileSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { isGltfMotion, readGltfMotion } from 'threepoint/avatar/file/motion-source';
import { reasonOf } from 'threepoint/core/errors/reasons';
import { type MocapSource, readOurMotion } from 'threepoint/core/mocap/prepare-mocap';
import { finishWork } from 'threepoint/core/motion/work';

interface Request {
  readonly files: readonly string[];
  readonly map: string | null;
  readonly out: string;
}

const textOf = (path: string) => ({ name: basename(path), text: readFileSync(path, 'utf8') });

/** Returns the file whose frame is the rest of a map; null: there is none. A faulty map is refused by its reader. */
function restFileOf(map: string): string | null {
  try {
    const file: unknown = JSON.parse(readFileSync(map, 'utf8'))?.restFrame?.file;
    return typeof file === 'string' ? join(dirname(map), file) : null;
  } catch (error) {
    if (error instanceof SyntaxError) return null;
    throw error;
  }
}

async function sourceOf(path: string, map: string | null): Promise<MocapSource> {
  const name = basename(path);
  const rest = map === null ? null : restFileOf(map);
  const mapped = { ...(map !== null && { map: textOf(map) }), ...(rest !== null && { rest: textOf(rest) }) };
  if (!isGltfMotion(name)) return { format: 'bvh', ...textOf(path), ...mapped };
  return { name, ...(await readGltfMotion(new Uint8Array(readFileSync(path)).buffer, name)), ...mapped };
}

/** What is read of one file; a fault becomes its sentence, and the other files are read. */
async function read(path: string, i: number, { map, out }: Request) {
  try {
    const { motion, notes, doubts } = finishWork(readOurMotion(await sourceOf(path, map)));
    const { positions, rotations, rateHz, frameCount } = motion;
    writeFileSync(join(out, `${i}.positions`), positions);
    writeFileSync(join(out, `${i}.rotations`), rotations);
    const rest = Object.fromEntries([...motion.rest].map(([joint, { x, y, z }]) => [joint, [x, y, z]]));
    return { rateHz, frameCount, rest, notes: [...notes, ...doubts] };
  } catch (error) {
    const reason = reasonOf(error);
    return { refused: reason.startsWith(basename(path)) ? reason : `${basename(path)}: ${reason}` };
  }
}

const request = JSON.parse(readFileSync(0, 'utf8')) as Request;
const found = await Promise.all(request.files.map((path, i) => read(path, i, request)));
writeFileSync(join(request.out, 'index.json'), JSON.stringify(found));
