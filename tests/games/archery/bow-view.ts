import { add, identity, type Quat, rotate, type Vec3, vec3 } from 'threepoint/math';
import type { BowView } from '../../../src/games/archery/archery-state';
import { arrowRestHeight, braceHeight } from '../../../src/games/archery/bow';

/** A bow held at a place, its string pulled straight back by `draw` [m] and aside by `slip`, in the bow's own axes. */
export function bowView(
  draw: number,
  { at = vec3(0, 1.4, -0.6), turn = identity, slip = vec3(0, 0, 0) }: { at?: Vec3; turn?: Quat; slip?: Vec3 } = {},
): BowView {
  const nockPoint = add(at, rotate(turn, add(vec3(0, arrowRestHeight, braceHeight + draw), slip)));
  return {
    bowSide: 'left',
    bow: { position: at, orientation: turn },
    nockPoint,
    draw,
    stage: draw > 0 ? 'drawing' : 'empty',
    arrow: draw > 0 ? { nock: nockPoint, direction: rotate(turn, vec3(0, 0, -1)) } : null,
  };
}
