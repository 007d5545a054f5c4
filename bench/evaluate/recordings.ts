import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { type Calibration, estimatedJoints, type TrackingFrame } from 'threepoint/core';
import { type Quat, type TrackedPose, type Vec3, vec3 } from 'threepoint/math';
import * as v from 'valibot';

const tilt = v.optional(v.object({ pitch: v.number(), yaw: v.number() }));

/** What training/threepoint_training/recordings.py writes. */
const indexSchema = v.object({
  version: v.literal(1),
  rateHz: v.pipe(v.number(), v.minValue(1)),
  corpusHash: v.string(),
  columns: v.array(v.string()),
  people: v.record(v.string(), v.object({ eyeHeight: v.number(), armSpan: v.number(), forearm: v.number() })),
  clips: v.array(
    v.object({
      name: v.string(),
      person: v.string(),
      file: v.string(),
      frames: v.number(),
      handTilts: v.optional(v.object({ left: tilt, right: tilt })),
    }),
  ),
  problems: v.array(v.string()),
});

export type RecordingIndex = v.InferOutput<typeof indexSchema>;

export const readIndex = (folder: string): RecordingIndex =>
  v.parse(indexSchema, JSON.parse(readFileSync(join(folder, 'index.json'), 'utf8')));

/** Returns the people of these clips, sorted by name. */
export const peopleOf = (clips: readonly { readonly person: string }[]): string[] =>
  [...new Set(clips.map(({ person }) => person))].sort();

/** Joints of the truth that the measures and figures use. */
export const truthJoints = [...estimatedJoints, 'leftHand', 'rightHand', 'neck', 'head'] as const;
export type TruthJoint = (typeof truthJoints)[number];

export interface RecordedFrame {
  readonly frame: TrackingFrame;
  readonly truth: Readonly<Record<TruthJoint, Vec3>>;
}

/** What a calibration knows beside height and span. */
export interface KnownMeasures {
  /**
   * How the hands stand to their forearms, as the guided calibration measures it: by what the person's other clips
   * show.
   */
  readonly hands?: boolean | undefined;
  /** How long the forearm is, as its owner types it. */
  readonly forearm?: boolean | undefined;
}

/** The body that a clip's person would have calibrated. */
export function calibrationOf(
  index: RecordingIndex,
  { person, handTilts }: RecordingIndex['clips'][number],
  known: KnownMeasures = {},
): Calibration {
  const measures = index.people[person];
  if (!measures) throw new Error(`index.json: clips of ${person}, but no such person`);
  const { eyeHeight, armSpan, forearm } = measures;
  return { eyeHeight, armSpan, ...(known.forearm && { forearm }), ...(known.hands && { handTilts }) };
}

/** The numbers of one clip: `point(name)` reads the three columns name.x, .y and .z of a row. */
export function openClip(folder: string, index: RecordingIndex, clip: RecordingIndex['clips'][number]) {
  const bytes = readFileSync(join(folder, clip.file));
  const width = index.columns.length;
  if (bytes.length !== clip.frames * width * 4) {
    throw new Error(`${clip.file}: ${bytes.length} bytes, ${clip.frames} frames need ${clip.frames * width * 4}`);
  }
  const numbers = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  const columnOf = (name: string): number => {
    const column = index.columns.indexOf(name);
    if (column < 0) throw new Error(`index.json: no column ${name}`);
    return column;
  };
  const at = (row: number, column: number): number => numbers[row * width + column] ?? Number.NaN;
  const point = (name: string) => {
    const column = columnOf(`${name}.x`);
    return (row: number): Vec3 => vec3(at(row, column), at(row, column + 1), at(row, column + 2));
  };
  return { frames: clip.frames, columnOf, at, point };
}

/** All frames of one clip, in order. */
export function readClip(
  folder: string,
  index: RecordingIndex,
  clip: RecordingIndex['clips'][number],
): RecordedFrame[] {
  const { columnOf, at: numberAt, point: pointOf } = openClip(folder, index, clip);
  const poses = { head: columnOf('head.px'), leftHand: columnOf('leftHand.px'), rightHand: columnOf('rightHand.px') };
  const truths = truthJoints.map((joint) => [joint, pointOf(`truth.${joint}`)] as const);
  return Array.from({ length: clip.frames }, (_, row) => {
    const at = (column: number): number => numberAt(row, column);
    const pose = (column: number): TrackedPose => ({
      position: vec3(at(column), at(column + 1), at(column + 2)),
      orientation: unit(at(column + 3), at(column + 4), at(column + 5), at(column + 6)),
      tracking: 'tracked',
    });
    return {
      frame: {
        time: row / index.rateHz,
        head: pose(poses.head),
        leftHand: pose(poses.leftHand),
        rightHand: pose(poses.rightHand),
      },
      truth: Object.fromEntries(truths.map(([joint, at]) => [joint, at(row)])) as Record<TruthJoint, Vec3>,
    };
  });
}

/** Single precision leaves quaternions a little off their length. */
function unit(x: number, y: number, z: number, w: number): Quat {
  const l = Math.hypot(x, y, z, w);
  return { x: x / l, y: y / l, z: z / l, w: w / l };
}
