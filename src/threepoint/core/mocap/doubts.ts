import { sides } from '../math/side';
import { median } from '../math/statistics';
import { cross, dot, length, lerp, normalise, subtract, up, type Vec3, zero } from '../math/vec3';
import { sampledFrames } from './body-axes';
import type { TruthJoint } from './skeleton-map';
import { positionAt, type TruthMotion } from './truth-motion';

/** A pelvis is further than this [m] off the middle of the feet in no motion for long. */
const furthestPelvis = 0.5;
/** Elbows lie further than this [m] behind the shoulders, when they are behind the back. */
const behindBack = 0.1;

/** Methods that all err by more than this [cm] on average show a file that was read wrongly. */
const maxError = 12;

/** Returns the doubt that the mean errors [cm] of all measured methods raise; null: they raise none. */
export const doubtOfErrors = (means: readonly number[]): string | null =>
  means.length > 0 && means.every((mean) => mean > maxError)
    ? `this cannot be right: the error of every method is over ${maxError} cm; look at the truth before the figures`
    : null;

/** Returns the implausible properties of a motion, a sentence each: figures that are measured on it are unreliable. */
export function doubtsOf(motion: TruthMotion): readonly string[] {
  const { rest, frameCount } = motion;
  const doubts: string[] = [];
  const pelvis: number[] = [];
  let [frames, behind, lying] = [0, 0, 0];
  for (const frame of sampledFrames(frameCount)) {
    frames += 1;
    const at = (joint: TruthJoint): Vec3 => positionAt(motion, frame, joint);
    const hips = at('hips');
    const trunk = normalise(subtract(at('neck'), hips), zero);
    if (dot(trunk, up) < 0.5) lying += 1;
    else if (rest.has('leftFoot') && rest.has('rightFoot')) {
      const middle = lerp(at('leftFoot'), at('rightFoot'), 0.5);
      pelvis.push(length({ ...subtract(hips, middle), y: 0 }));
    }
    const ahead = normalise(cross(trunk, subtract(at('rightUpperArm'), at('leftUpperArm'))), zero);
    const back = sides.every(
      (side) => dot(subtract(at(`${side}LowerArm`), at(`${side}UpperArm`)), ahead) < -behindBack,
    );
    if (back) behind += 1;
  }
  const off = median(pelvis);
  if (pelvis.length > frames / 2 && off > furthestPelvis)
    doubts.push(`this cannot be right: the pelvis is ${Math.round(100 * off)} cm off the middle of the feet`);
  if (behind > 0.6 * frames) doubts.push('this cannot be right: both elbows are behind the back in most frames');
  if (lying > 0.5 * frames) doubts.push('the trunk lies in most frames');
  return doubts;
}
