import type { Body } from '../humanoid/find-body';
import type { LimbPair } from '../humanoid/limb-pairs';
import type { LimbSides } from '../humanoid/match-humanoid';
import { otherSide } from '../math/side';
import { cross, distance, dot, length, normalise, reject, subtract, type Vec3, zero } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion } from '../motion/imported-motion';
import { sampledFrames } from './body-axes';

/** The largest number of frames that are sampled. */
const maxFrames = 200;
/** The smallest offset of a knee or an elbow from the line of its limb, as a fraction of the limb. */
const bent = 0.05;
/** The smallest cosine between a foot and the front. */
const footAhead = 0.5;
/** The smallest step of the hips between sampled frames that shows a way, as a fraction of the legs. */
const smallestStep = 0.02;
/** The fraction of votes that a front has more than the back has where it is clear. */
const clearMajority = 0.6;

/** Votes for the front of a body, positive, and for its back. */
interface Votes {
  sum: number;
  count: number;
}

const noVotes = (): Votes => ({ sum: 0, count: 0 });

const vote = (votes: Votes, value: number, least: number): void => {
  if (Math.abs(value) < least) return;
  votes.sum += Math.sign(value);
  votes.count += 1;
};

const isClear = ({ sum, count }: Votes, frames: number): boolean =>
  count >= 0.1 * frames && Math.abs(sum) > clearMajority * count;

/** Returns how far the middle joint of a limb lies ahead of the line between its ends, as a fraction of the limb. */
function bendAhead(positions: readonly Vec3[], { chain, at }: LimbPair['limbs'][0], ahead: Vec3): number {
  const [from, middle, to] = at.map((i) => positions[chain[i]!]!) as [Vec3, Vec3, Vec3];
  const along = normalise(subtract(to, from), zero);
  const aside = reject(subtract(middle, from), along);
  return dot(aside, ahead) / (distance(from, middle) + distance(middle, to));
}

/** Returns the line from the first limb of a pair to the other. */
function across(positions: readonly Vec3[], { limbs }: LimbPair): Vec3 {
  const [one, other] = limbs.map(({ chain, at }) => positions[chain[at[0]]!]!) as [Vec3, Vec3];
  return subtract(other, one);
}

/**
 * Returns the sides of the limbs of a body by its frames. Knees bend forward and toes point ahead, which shows the
 * front. Elbows bend back, and people mostly walk forward: that decides only where names do not.
 */
export function sidesInMotion(file: ImportedMotion, { legs, arms, trunk }: Body): LimbSides {
  const pair = legs ?? arms;
  const poses = createSkeletonPose(file.names.length);
  const [anatomy, habit, along] = [noVotes(), noVotes(), noVotes()];
  let [frames, before]: [number, Vec3 | null] = [0, null];
  for (const frame of sampledFrames(file.frameCount, maxFrames)) {
    const { positions } = file.pose(frame, poses);
    frames += 1;
    const hips = { ...positions[trunk[0]!]! };
    const trunkLine = subtract(positions[arms.root]!, hips);
    const above = normalise(trunkLine, zero);
    const aside = across(positions, pair);
    // The front if the first limb is the left one.
    const ahead = normalise(reject(cross(above, aside), above), zero);
    if (legs) vote(along, dot(normalise(across(positions, arms), zero), normalise(aside, zero)), 0.3);
    for (const limb of legs?.limbs ?? []) {
      vote(anatomy, bendAhead(positions, limb, ahead), bent);
      const [foot, toes] = [limb.chain[limb.at[2]], limb.chain[limb.at[2] + 1]];
      if (foot !== undefined && toes !== undefined && foot !== limb.chain[limb.at[1]])
        vote(anatomy, dot(normalise(subtract(positions[toes]!, positions[foot]!), zero), ahead), footAhead);
    }
    for (const limb of arms.limbs) vote(habit, -bendAhead(positions, limb, ahead), bent);
    const step = before ? dot(subtract(hips, before), ahead) : 0;
    vote(habit, step, smallestStep * length(trunkLine));
    before = hips;
  }
  const frontShown = isClear(anatomy, frames);
  const votes = frontShown ? anatomy : habit;
  const first = frontShown || isClear(votes, frames) ? (votes.sum > 0 ? 'left' : 'right') : null;
  const arm = !legs ? first : first && isClear(along, frames) ? (along.sum > 0 ? first : otherSide(first)) : null;
  return { placed: [legs ? first : null, arm], frontShown };
}
