import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import * as v from 'valibot';
import type { MeasuredFrame } from '../measures';
import { rounded } from '../measures';

/** Every so many frames of a piece are kept. */
export const frameInterval = 3;

/** Joints of some frames of one piece. */
export interface KeptFrames {
  readonly piece: string;
  readonly joints: readonly string[];
  /** Seconds of the clip, frame by frame. */
  readonly times: readonly number[];
  /** x, y, z [m] of each joint of each frame. */
  readonly positions: Float32Array;
}

export function keepFrames(piece: string, driven: readonly MeasuredFrame[], times: readonly number[]): KeptFrames {
  const joints = Object.keys(driven[0]?.joints ?? {}).sort();
  const rows = driven.flatMap((frame, row) => (row % frameInterval === 0 ? [{ frame, time: times[row] ?? 0 }] : []));
  const numbers = rows.flatMap(({ frame }) =>
    joints.flatMap((joint) => {
      const { x, y, z } = frame.joints[joint] as { x: number; y: number; z: number };
      return [x, y, z];
    }),
  );
  return { piece, joints, times: rows.map(({ time }) => time), positions: Float32Array.from(numbers) };
}

const indexSchema = v.record(
  v.string(),
  v.array(
    v.object({
      piece: v.string(),
      joints: v.array(v.string()),
      times: v.array(v.number()),
      offset: v.number(),
    }),
  ),
);

/** Row of the goldens to its pieces. */
export type FrameTable = Readonly<Record<string, readonly KeptFrames[]>>;

const filesIn = (folder: string) => ({ index: join(folder, 'frames.json'), numbers: join(folder, 'frames.f32') });

/** Motion of recorded people: written into a cache, never into the repository. */
export function writeFrames(folder: string, table: FrameTable): void {
  mkdirSync(folder, { recursive: true });
  const { index, numbers } = filesIn(folder);
  let offset = 0;
  const listed = Object.fromEntries(
    Object.entries(table).map(([row, pieces]) => [
      row,
      pieces.map(({ piece, joints, times, positions }) => {
        const at = offset;
        offset += positions.length;
        return { piece, joints, times, offset: at };
      }),
    ]),
  );
  const all = new Float32Array(offset);
  let next = 0;
  for (const { positions } of Object.values(table).flat()) {
    all.set(positions, next);
    next += positions.length;
  }
  writeFileSync(index, JSON.stringify(listed));
  writeFileSync(numbers, new Uint8Array(all.buffer));
}

/** What was written there; null: nothing was. */
export function readFrames(folder: string): FrameTable | null {
  const { index, numbers } = filesIn(folder);
  if (!existsSync(index) || !existsSync(numbers)) return null;
  const bytes = readFileSync(numbers);
  const all = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const listed = v.parse(indexSchema, JSON.parse(readFileSync(index, 'utf8')));
  return Object.fromEntries(
    Object.entries(listed).map(([row, pieces]) => [
      row,
      pieces.map(({ offset, ...piece }) => ({
        ...piece,
        positions: all.subarray(offset, offset + 3 * piece.joints.length * piece.times.length),
      })),
    ]),
  );
}

/** By how much [mm] the joints of one row lie elsewhere than they did. */
export interface FrameDifference {
  readonly row: string;
  readonly meanMm: number;
  readonly p99Mm: number;
  readonly maxMm: number;
  /** Piece, second and joint of the largest. */
  readonly worst: string;
}

/** Rows that both have; throws where a row's pieces or frames are not the same. */
export function compareFrames(frozen: FrameTable, now: FrameTable): FrameDifference[] {
  return Object.entries(now).flatMap(([row, pieces]) => {
    const before = frozen[row];
    return before ? [differenceOf(row, before, pieces)] : [];
  });
}

function differenceOf(row: string, before: readonly KeptFrames[], now: readonly KeptFrames[]): FrameDifference {
  const distances: number[] = [];
  let worst = { mm: -1, where: '' };
  now.forEach(({ piece, joints, times, positions }, number) => {
    const old = before[number];
    if (old?.piece !== piece || old.times.length !== times.length || old.joints.join() !== joints.join()) {
      throw new Error(`goldens: the frozen frames of “${row}” are of other pieces or joints than ${piece}: write anew`);
    }
    for (let at = 0; at < positions.length; at += 3) {
      const part = (axis: number) => positions[at + axis]! - old.positions[at + axis]!;
      const mm = Math.hypot(part(0), part(1), part(2)) * 1000;
      distances.push(mm);
      if (mm <= worst.mm) continue;
      const frame = Math.floor(at / 3 / joints.length);
      worst = { mm, where: `${piece}, ${times[frame]?.toFixed(2)} s, ${joints[(at / 3) % joints.length]}` };
    }
  });
  const sorted = Float64Array.from(distances).sort();
  const mean = sorted.reduce((sum, mm) => sum + mm, 0) / Math.max(1, sorted.length);
  return {
    row,
    meanMm: rounded(mean, 3),
    p99Mm: rounded(sorted[Math.floor(0.99 * sorted.length)] ?? 0, 3),
    maxMm: rounded(worst.mm, 3),
    worst: worst.where,
  };
}
