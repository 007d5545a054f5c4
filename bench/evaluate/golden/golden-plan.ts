import { nextRandom } from 'threepoint/math';
import { seedOf } from '../disturbances';
import { type MeasuredMethod, measuredMethods } from '../drive';
import { calibrationOf, type RecordingIndex, readClip } from '../recordings';
import { chooseClips } from '../robustness';
import { type Piece, situations, undisturbed } from '../situations';

/** Another laboratory's people (HDM05): joints are defined elsewhere, so that they make a row of their own. */
const otherLaboratory: ReadonlySet<string> = new Set(['901', '902', '903']);

/**
 * Minutes of recordings that a row covers: by group of people, and of all groups for each disturbance; the paper's
 * network, which takes four times as long, gets a share of them. Pieces of clips are at most so long [s].
 */
const extents = {
  full: {
    groups: { unseen: 16, otherLaboratory: 4, trainedOn: 16 },
    disturbed: 2.5,
    paperShare: 0.12,
    longestSeconds: 15,
  },
  quick: {
    groups: { unseen: 0.8, otherLaboratory: 0.2, trainedOn: 0.8 },
    disturbed: 0.4,
    paperShare: 0,
    longestSeconds: 6,
  },
} as const;
/** What is done to a piece needs so long [s]. */
const shortestDisturbedSeconds = 5;
export type Extent = keyof typeof extents;

type Group = keyof (typeof extents)['full']['groups'];

/** A piece that is still on disk: rows of a clip. */
export interface ListedPiece {
  readonly name: string;
  readonly clip: RecordingIndex['clips'][number];
  readonly first: number;
  readonly frames: number;
}

/** What makes one row of the goldens: an estimator in a situation over these pieces, in order. */
export interface GoldenJob {
  readonly row: string;
  readonly method: MeasuredMethod;
  /** A key of `situations`; null: undisturbed. */
  readonly situation: string | null;
  readonly pieces: readonly ListedPiece[];
}

const titles: Readonly<Record<Group, string>> = {
  unseen: 'people held out',
  otherLaboratory: 'people of another laboratory (HDM05)',
  trainedOn: 'people trained on',
};

/** One piece of a clip, of so many frames at most and from a seeded row on: the same in every selection of clips. */
function pieceOf(clip: RecordingIndex['clips'][number], longest: number): ListedPiece {
  const frames = Math.min(clip.frames, longest);
  const first = Math.floor(nextRandom({ seed: seedOf(`piece ${clip.name}`) }).value * (clip.frames - frames + 1));
  return { name: clip.name, clip, first, frames };
}

/**
 * Lists all rows of the goldens; `trainedOn`: people that a network was trained on. Longest first, so that workers end
 * together.
 */
export function planGoldens(index: RecordingIndex, trainedOn: ReadonlySet<string>, extent: Extent): GoldenJob[] {
  const { groups, disturbed, paperShare, longestSeconds } = extents[extent];
  const groupOf = (person: string): Group => {
    if (otherLaboratory.has(person)) return 'otherLaboratory';
    return trainedOn.has(person) ? 'trainedOn' : 'unseen';
  };
  const of = (group: Group): ListedPiece[] =>
    index.clips
      .filter(({ person }) => groupOf(person) === group)
      .map((clip) => pieceOf(clip, longestSeconds * index.rateHz));
  const choose = (pieces: readonly ListedPiece[], minutes: number): ListedPiece[] =>
    pieces.length > 0 && minutes > 0 ? chooseClips(pieces, minutes * 60 * index.rateHz) : [];
  const isLong = ({ frames }: ListedPiece): boolean => frames >= shortestDisturbedSeconds * index.rateHz;

  const jobs = measuredMethods.flatMap((method): GoldenJob[] => {
    const share = method === 'paper' ? paperShare : 1;
    const names = Object.keys(groups) as Group[];
    const still = names.map((group) => ({
      row: `${method} · ${titles[group]}`,
      method,
      situation: null,
      pieces: choose(of(group), groups[group] * share),
    }));
    const long = names.map((group) => of(group).filter(isLong)).filter((candidates) => candidates.length > 0);
    const pieces = long.flatMap((candidates) => choose(candidates, (disturbed * share) / long.length));
    const disturbances = Object.keys(situations).map((situation) => ({
      row: `${method} · ${situation}`,
      method,
      situation,
      pieces,
    }));
    return [...still, ...disturbances].filter((job) => job.pieces.length > 0);
  });
  const cost = (job: GoldenJob): number => job.pieces.reduce((sum, { frames }) => sum + frames, 0);
  return jobs.sort((a, b) => cost(b) - cost(a));
}

/** The frames of a piece, as they were recorded. */
export function readPiece(folder: string, index: RecordingIndex, { name, clip, first, frames }: ListedPiece): Piece {
  return {
    name,
    calibration: calibrationOf(index, clip),
    frames: readClip(folder, index, clip).slice(first, first + frames),
  };
}

/** The stage of a job. */
export function stageOf({ situation }: GoldenJob) {
  const stage = situation === null ? undisturbed : situations[situation];
  if (!stage) throw new Error(`goldens: no situation “${situation}”`);
  return stage;
}
