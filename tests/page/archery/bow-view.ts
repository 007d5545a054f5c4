import { type Group, Vector3 } from 'three';
import { add, identity, type Quat, rotate, type Vec3, vec3 } from 'threepoint/math';
import { type BowView, braceHeight } from 'threepoint-games/archery';
import { arrowRestHeight } from '../../../src/games/archery/bow';

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

/** The string as it is drawn, from the upper tip over the nock point to the lower tip, floor frame. */
export function drawnString(bow: Group): readonly [Vec3, Vec3, Vec3] {
  bow.updateMatrixWorld();
  const [upper, lower] = [bow.children[2]!, bow.children[3]!];
  const tip = vec3(0, -0.5, 0);
  return [
    upper.localToWorld(new Vector3().copy(tip)),
    upper.localToWorld(new Vector3(0, 0.5, 0)),
    lower.localToWorld(new Vector3().copy(tip)),
  ];
}
