import { recordOf } from 'threepoint/core';
import { stageNames } from '../src/page/shell/session/frame-timing';
import type { Allocations } from './allocations';
import { type WorldCounts, whole } from './counts';
import type { MeasuredNetwork } from './networks';
import type { FrameTimes } from './page/frame-times';
import type { PageResult } from './page/main';
import { type PairedRatio, pairedRatio } from './paired-ratio';
import { tableRow } from './table-row';

/** What opening the real page afresh took, and what had to travel for it, as unpacked. */
export interface Visit {
  /** Until the first body is on the screen [ms]: median of three. */
  readonly firstBodyMs: number;
  readonly bytes: Readonly<Record<'app' | 'wasm' | 'models' | 'avatars', number>>;
}

const row = (label: string, cells: readonly (string | number)[]) => console.log(tableRow(label, cells));

export function printAllocations({ bytes }: Allocations): void {
  console.log('\nWhat a frame leaves to the collector [kB]');
  row('', ['all', 'three.js']);
  for (const [name, { all, three }] of Object.entries(bytes))
    row(
      name,
      [all, three].map((bytes) => (bytes / 1000).toFixed(1)),
    );
}

/** Prints the call sites with the most allocated bytes. */
export function printSites({ sites }: Allocations): void {
  for (const [name, places] of Object.entries(sites)) {
    console.log(`\n${name}: the functions that leave most [bytes a frame]`);
    for (const { name: site, at, bytes } of places.slice(0, 40))
      console.log(`  ${String(bytes).padStart(8)}  ${site.padEnd(36)} ${at}`);
  }
}

export function printNetworks(costs: Readonly<Record<string, MeasuredNetwork>>): void {
  console.log('\nThe learned network, by the way to run it');
  row('', ['in frame p50', 'p95 [ms]', 'thread p50', 'p95 [ms]', 'first [ms]', 'kB', 'ran on']);
  for (const [way, { inFrameMs, threadMs, firstBodyMs, bytes, provider }] of Object.entries(costs)) {
    const times = [inFrameMs.p50, inFrameMs.p95, threadMs.p50, threadMs.p95].map((ms) => ms.toFixed(3));
    row(way, [...times, firstBodyMs.toFixed(0), (bytes / 1000).toFixed(0), provider]);
  }
}

/** By world: both eyes and shadows, the part of the shadows, the mirror's reflections, and all of it. */
export function printCounts(counts: Readonly<Record<string, WorldCounts>>): void {
  console.log('\nThe most that a picture of a world takes: draw calls and thousands of triangles; textures [MB]');
  row('', ['eyes', 'k', 'shadows', 'k', 'mirror', 'k', 'all', 'k', 'textures']);
  for (const [name, { scene, shadows, mirror, texturesMB }] of Object.entries(counts)) {
    const eyes = {
      drawCalls: scene.drawCalls - shadows.drawCalls,
      triangles: scene.triangles - shadows.triangles,
    };
    const all = whole({ scene, mirror });
    const cells = [eyes, shadows, mirror, all].flatMap((part) => [part.drawCalls, Math.round(part.triangles / 1000)]);
    row(name, [...cells, texturesMB.toFixed(1)]);
  }
}

const share = (value: number) => `${(100 * value).toFixed(1)} %`;

/** By method: within the frame, with what it leaves for later, and the whole. */
export function printCosts(frames: PageResult<'frames'>): void {
  const { first, settled, shown } = frames.costs;
  for (const [title, table] of [
    ['In the animation frame, after ten seconds of it [ms]', settled.inFrameMs],
    ['The same in the first ten seconds [ms]', first.inFrameMs],
    ['The same after them, while the browser shows the canvas [ms]', shown.inFrameMs],
    ["With what it leaves for after the frame on the page's thread, after ten seconds [ms]", settled.withLaterMs],
    ['The same in the first ten seconds [ms]', first.withLaterMs],
    ['Whole frame, until the picture is drawn [ms]', settled.frameMs],
    ["Of it, on the page's own thread [ms]", settled.threadMs],
    ['Whole frame, while the browser shows the canvas [ms]', shown.frameMs],
    ["Of it, on the page's own thread [ms]", shown.threadMs],
  ] as const) {
    console.log(`\n${title}, ${frames.frames} frames each`);
    row('', ['p50', 'p95', 'p99']);
    for (const [name, { p50, p95, p99 }] of Object.entries(table))
      row(name, [p50.toFixed(3), p95.toFixed(3), p99.toFixed(3)]);
  }
}

const compared = ['ik', 'paper', 'learned'] as const;

/**
 * What is promised of a frame, as ratios within this run, round by round: the machine's speed and its other work are in
 * both.
 */
export function ratiosOf({ blocks: { inFrameMs, threadMs } }: PageResult<'frames'>) {
  const to = (costs: typeof inFrameMs, other: 'ccdik' | 'ik') =>
    recordOf(compared, (name) => pairedRatio(costs[name], costs[other]));
  return { inFrameToCcdIk: to(inFrameMs, 'ccdik'), threadToIk: to(threadMs, 'ik') };
}

export function printRatios({ inFrameToCcdIk, threadToIk }: ReturnType<typeof ratiosOf>): void {
  const { pairs } = inFrameToCcdIk.ik;
  console.log(`\nRatios of the blocks' medians after ten seconds, with 95 % confidence; ${pairs} pairs`);
  row('', ['to CCD-IK', 'from', 'to', 'thread to IK', 'from', 'to']);
  const cells = ({ ratio, low, high }: PairedRatio, digits: number) =>
    [ratio, low, high].map((value) => value.toFixed(digits));
  for (const name of compared) row(name, [...cells(inFrameToCcdIk[name], 2), ...cells(threadToIk[name], 3)]);
}

export function printStages(frames: PageResult<'frames'>): void {
  console.log('\nStages, median, after ten seconds [ms]');
  row('', stageNames);
  for (const [name, stages] of Object.entries(frames.stagesMs))
    row(
      name,
      stageNames.map((stage) => stages[stage].toFixed(3)),
    );
}

const frameColumns = ['min', 'mean', 'p50', 'p95', 'max', '72 Hz', '90 Hz', 'drawn p50', 'drawn p95'];

const frameCells = ({ min, mean, p50, p95, max, missed72, missed90, drawnP50, drawnP95 }: FrameTimes) => [
  ...[min, mean, p50, p95, max].map((ms) => ms.toFixed(2)),
  share(missed72),
  share(missed90),
  drawnP50.toFixed(1),
  drawnP95.toFixed(1),
];

export function printArchery(archery: PageResult<'archery'>): void {
  console.log("\nA round of archery, frame on the page's own thread [ms]; missed: share later than that rate allows");
  row('', [...frameColumns, 'points']);
  for (const [name, times] of Object.entries(archery)) row(name, [...frameCells(times), times.score]);
}

export function printCourt(ball: PageResult<'ball'>): void {
  console.log("\nThe ball court, frame on the page's own thread [ms]; each other avatar's part of it");
  row('', ['avatars', ...frameColumns, 'each p50', 'p95']);
  for (const [name, crowds] of Object.entries(ball)) {
    for (const times of crowds) {
      const remote = [times.perRemoteMs, times.perRemoteP95Ms].map((ms) => ms?.toFixed(3) ?? '–');
      row(name, [times.avatars, ...frameCells(times), ...remote]);
    }
  }
}

export function printCrowd({ others, aloneMs, beyondMs, receivedMs, bentMs, drawnMs }: PageResult<'crowd'>): void {
  console.log(
    `\n${others} others at 72 Hz take ${beyondMs.toFixed(2)} ms of the page's thread (p50) beyond the ${aloneMs.toFixed(2)} ms of a frame without them: ` +
      `packets ${receivedMs.toFixed(2)}, bodies played back and bent ${bentMs.toFixed(2)}, drawn ${drawnMs.toFixed(2)}`,
  );
}

export function printOpening({ sessionCreateMs, firstInferenceMs }: PageResult<'frames'>): void {
  const whole = (values: Readonly<Record<string, number>>) =>
    Object.entries(values)
      .map(([name, value]) => `${name} ${value.toFixed(0)}`)
      .join(', ');
  console.log(`\nSession creation [ms]: ${whole(sessionCreateMs)}; first inference [ms]: ${whole(firstInferenceMs)}`);
}

export function printVisit({ firstBodyMs, bytes }: Visit): void {
  console.log(`\nFirst body on the screen: ${firstBodyMs} ms after opening the page (median of 3)`);
  const kilobytes = Object.entries(bytes).map(([kind, size]) => `${kind} ${(size / 1000).toFixed(0)} kB`);
  console.log(`First visit, unpacked: ${kilobytes.join(', ')}`);
}
