import { copyVec3, makeTransform, sides } from 'threepoint/math';
import { createPlayerPostures, makePosture } from '../../../src/games/ball/player-postures';
import type { SimulatedInput } from '../../../src/games/simulated-input';

/** The input of a thrower whose arms hang. */
export function hangingThrower(eyeHeight: number): SimulatedInput {
  const postures = createPlayerPostures({ eyeHeight, arenaFromFloor: makeTransform() });
  const posture = makePosture();
  copyVec3(postures.eyes, posture.eyes);
  for (const side of sides) postures.hang(side, posture.eyes, posture[side]);
  return postures.inputFor(posture, 1, 1, 1);
}
