import { vec3 } from '../math/vec3';
import { createSkeletonPose } from './imported-motion';
import { type Motion, poseBones } from './motion';
import { turnPoint } from './motion-bones';

const framesPerStep = 64;

/**
 * Writes a table of joints, in parts: a row per frame with its time [s], whether each hand was seen (1, 0), and the
 * position of every measured joint [m, floor frame: +Y up, −Z forward]. Joints that are not measured (legs) have no
 * columns. Yields the fraction [0, 1] that is done.
 */
export function* writeCsv(motion: Motion): Generator<number, readonly string[]> {
  const { bones, times, seen } = motion;
  const measuredBones = bones.filter(({ measured }) => measured);
  const columns = measuredBones.flatMap(({ name }) => ['x', 'y', 'z'].map((axis) => `${name}_${axis}`));
  const parts = [`${['time', 'left_hand_seen', 'right_hand_seen', ...columns].join(',')}\n`];
  const posed = createSkeletonPose(bones.length);
  const place = vec3(0, 0, 0);
  let lines = '';
  for (let frame = 0; frame < times.length; frame++) {
    poseBones(motion, frame, posed);
    const row = [times[frame]!.toFixed(6), String(seen[frame]! & 1), String(seen[frame]! >> 1)];
    for (let bone = 0; bone < measuredBones.length; bone++) {
      const { x, y, z } = turnPoint(posed.positions[bone]!, place);
      row.push(x.toFixed(6), y.toFixed(6), z.toFixed(6));
    }
    lines += `${row.join(',')}\n`;
    if (frame % framesPerStep !== framesPerStep - 1) continue;
    parts.push(lines);
    lines = '';
    yield frame / times.length;
  }
  parts.push(lines);
  return parts;
}
