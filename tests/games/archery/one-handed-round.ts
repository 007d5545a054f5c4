import { addScaled, normalise, otherSide, reject, type Side, up, type Vec3, vec3 } from 'threepoint/math';
import { type ArcheryState, archeryRules, braceHeight } from 'threepoint-games/archery';
import { arrowRestHeight } from '../../../src/games/archery/bow';
import { releaseDirection } from '../../../src/games/archery/flight';
import { oneHandedDraw } from '../../../src/games/archery/nocked-arrow';
import { bowman } from './bowman';

/** Returns the direction of the knuckles of a hand with the bow at `bowAt` for its arrow to hit the target. */
function knucklesTowards(target: Vec3, bowAt: Vec3): Vec3 {
  // It depends a little on where the nock lies, and that on where they point.
  let knuckles = vec3(0, 0, -1);
  for (let round = 0; round < 6; round++) {
    const rest = addScaled(bowAt, normalise(reject(up, knuckles)), arrowRestHeight);
    knuckles = releaseDirection(target, addScaled(rest, knuckles, -braceHeight - oneHandedDraw), oneHandedDraw)!;
  }
  return knuckles;
}

/** A round after one hand alone has shot at each of its targets. */
export function shotWithOneHand(bowSide: Side, round: ArcheryState): ArcheryState {
  const archer = bowman({ bowSide, oneHanded: true });
  const bowAt = vec3(bowSide === 'left' ? -0.1 : 0.1, 1.4, -0.5);
  let state = round;
  for (const { centre } of round.targets) {
    const pose = { bowAt, knuckles: knucklesTowards(centre, bowAt), lost: [otherSide(bowSide)] };
    archer.forget().hold(pose, 0.1, 0).hold(pose, 2, 1).hold(pose, 1, 0);
    for (const { actions } of archer.frames) state = archeryRules.step(state, actions).state;
  }
  return state;
}
