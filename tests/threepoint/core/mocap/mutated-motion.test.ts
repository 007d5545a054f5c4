// @module-tag full
import { expect, test } from 'vitest';
import { readGlbChunks } from '../../../../src/threepoint/avatar/file/glb-chunks';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import { type MocapSource, prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { writeVrma } from '../../../../src/threepoint/core/motion/write-vrma';
import { reportFigures } from '../../../reliability/report-figures';
import { choicesBy, containersIn, mutatedFiles, mutationSeed, ReadingCosts } from '../../mutated-files';
import { actingPerson, bytesOf, firstFrames } from '../motion/moved-person';
import { madeBvh } from './made-bvh';

let chance = createRandom(0);
const { below, oneOf, flipBits } = choicesBy(() => chance());

/** Reads spoiled files; each is refused in a sentence or becomes finite trackers, with a second of work at most. */
async function readAll(format: string, count: number, spoil: () => MocapSource & { readonly bytes: number }) {
  // Every format has its own numbers, so that one can be run without the other.
  chance = createRandom(mutationSeed);
  const counts = { refused: 0, read: 0 };
  const costs = new ReadingCosts();
  for (let i = 0; i < count; i++) {
    const { bytes, ...source } = spoil();
    const read = await costs.measure(bytes, () => finishWork(prepareMocap(source)));
    if (read instanceof Error) {
      const { message, stack } = read;
      expect(message, `file ${i}: ${stack}`).toMatch(/^wave\.(bvh|vrma): /);
      expect(message, `file ${i}: ${stack}`).not.toMatch(
        /undefined|is not a function|Cannot read|Invalid|out of memory/,
      );
      counts.refused += 1;
    } else {
      counts.read += 1;
      for (const { tracked } of read.clips) expect(tracked.every(Number.isFinite), `file ${i}`).toBe(true);
    }
  }
  reportFigures('mutated-motion', {
    ...{ [`${format} files`]: count, [`${format} refused`]: counts.refused, [`${format} read`]: counts.read },
    ...costs.figures(format),
  });
  expect(costs.longestMs).toBeLessThan(1000);
  expect(costs.largestMultiple).toBeLessThan(3);
  expect(counts.refused).toBeGreaterThan(count / 20);
  expect(counts.read).toBeGreaterThan(count / 20);
}

test('spoiled BVH files are refused in a sentence or read as finite numbers, in a moment', {
  timeout: 3_600_000,
}, () => {
  const frames = { frames: 36 };
  const originals = [
    madeBvh(frames),
    madeBvh({ ...frames, positionOf: (offset) => offset }),
    madeBvh({ ...frames, nameOf: (name) => `mixamorig:${name}`, rootZUp: true }),
    madeBvh({ ...frames, numberOf: (value) => value.toFixed(2).replace('.', ',') }),
  ].map((text) => text.split('\n'));
  const words = [
    '{',
    '}',
    'JOINT',
    'ROOT a',
    'End Site',
    'OFFSET 1e308 1 1',
    'OFFSET 0 0 0',
    'CHANNELS 3 Xrotation',
    'MOTION',
    '-1',
    '1e9',
    'NaN',
    '0',
    '',
    'Frames: 3',
  ];
  const ways: readonly ((lines: string[]) => unknown)[] = [
    (lines) => lines.splice(below(lines.length), 1 + below(3)),
    (lines) => lines.splice(below(lines.length), 0, oneOf(words)),
    (lines) => lines.splice(below(lines.length), 0, lines[below(lines.length)]!),
    (lines) => (lines.length = 1 + below(lines.length)),
    (lines) => {
      // Mostly the hierarchy: its 120 lines decide how the rest is read.
      const at = below(chance() < 0.8 ? Math.min(120, lines.length) : lines.length);
      const parts = lines[at]!.split(' ');
      parts[below(parts.length)] = oneOf(words);
      lines[at] = parts.join(' ');
    },
    (lines) => {
      const at = below(lines.length);
      const line = [...lines[at]!];
      line[below(line.length || 1)] = String.fromCharCode(32 + below(95));
      lines[at] = line.join('');
    },
  ];
  return readAll('bvh', mutatedFiles(2000), () => {
    const lines = [...oneOf(originals)];
    for (let i = 1 + below(2); i > 0 && lines.length > 1; i--) oneOf(ways)(lines);
    const text = lines.join('\n');
    return { format: 'bvh', name: 'wave.bvh', text, bytes: text.length };
  });
});

test('spoiled VRM Animations are refused in a sentence or read as finite numbers, in a moment', {
  timeout: 3_600_000,
}, () => {
  const { json, binary } = readGlbChunks(bytesOf(writeVrma(firstFrames(actingPerson(1).motion, 44))))!;
  const odd: readonly unknown[] = [null, true, '', [], {}, [null], -1, 0, 0.5, 1e9, 2 ** 31, 1e308, 'VEC3', 5126];
  return readAll('vrma', mutatedFiles(500), () => {
    const description: unknown = JSON.parse(json);
    const bytes = new Uint8Array(binary.slice());
    if (chance() < 0.3) flipBits(bytes, 1 + below(8));
    else {
      for (let i = 1 + below(3); i > 0; i--) {
        const container = oneOf(containersIn(description)) as Record<string, unknown>;
        const keys = Object.keys(container);
        const key = keys.length > 0 ? oneOf(keys) : 'extras';
        if (chance() < 0.4) delete container[key];
        else container[key] = structuredClone(chance() < 0.5 ? oneOf(odd) : oneOf(containersIn(description)));
      }
    }
    const size = bytes.length + JSON.stringify(description).length;
    return { format: 'gltf', name: 'wave.vrma', description, binary: bytes, bytes: size };
  });
});
