// Reads every file of motion of a folder as the page does, and prints a line for each: what was read and assumed, or
// why it was refused.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { reasonOf } from '../../src/threepoint/core/errors/reasons';
import { armSpanAtRest, eyeHeightAtRest } from '../../src/threepoint/core/mocap/rest-joints';
import { type FileBytes, FileReaderProcess } from './reader-process';

/** Returns the skeleton of an AMC file: the one whose name its own begins with, or the only one beside it. */
function skeletonOf(name: string, folder: string, names: readonly string[]): FileBytes['skeleton'] {
  const skeletons = names.filter((each) => /\.asf$/i.test(each));
  const own = skeletons.find((each) => name.startsWith(each.replace(/\.asf$/i, ''))) ?? skeletons[0];
  if (own === undefined) throw new Error('no .asf skeleton beside it');
  return { name: own, text: readFileSync(join(folder, own), 'utf8') };
}

const metres = (value: number | null): string => (value === null ? 'unknown' : `${value.toFixed(2)} m`);

/** Returns what was read of a file, on one line. */
async function lineOf(name: string, folder: string, names: readonly string[]): Promise<string> {
  try {
    const skeleton = /\.amc$/i.test(name) ? skeletonOf(name, folder, names) : undefined;
    const bytes = new Uint8Array(readFileSync(join(folder, name))).buffer;
    const { motion, notes, doubts } = await reader.read('truth', { name, bytes, ...(skeleton && { skeleton }) });
    const { rest, rateHz, frameCount } = motion;
    const figures = [
      `${(frameCount / rateHz).toFixed(1)} s at ${Number(rateHz.toPrecision(3))} Hz`,
      `eyes at ${metres(eyeHeightAtRest(rest))}`,
      `arm span ${metres(armSpanAtRest(rest))}`,
    ];
    return [`${name}: ${figures.join(', ')}`, ...notes, ...doubts.map((doubt) => `DOUBT: ${doubt}`)].join('; ');
  } catch (error) {
    const reason = reasonOf(error);
    return `REFUSED ${reason.startsWith(name) ? reason : `${name}: ${reason}`}`.replaceAll('\n', ' ');
  }
}

using reader = new FileReaderProcess();
const [folder] = process.argv.slice(2) as [string];
try {
  const names = readdirSync(folder).sort();
  for (const name of names)
    if (/\.(bvh|amc|vrma|fbx|glb|gltf)$/i.test(name)) console.log(await lineOf(name, folder, names));
} catch (error) {
  console.error(reasonOf(error));
  process.exitCode = 1;
}
