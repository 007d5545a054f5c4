import { conjugate, copyQuat, type MutableQuat, multiply, type Quat, quat, rotate, setQuat } from '../math/quat';
import { add, copyVec3, type MutableVec3, setVec3, subtract, vec3 } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion, type SkeletonPose } from './imported-motion';
import { Lines, Rows, shown } from './lines';
import { type AsfSkeleton, fromEuler } from './read-asf';

const framesPerStep = 16;
/** The units of angles [rad] by their keyword in a file's header; without one, the skeleton's unit applies. */
const radiansPerUnit: Readonly<Record<string, number>> = { ':DEGREES': Math.PI / 180, ':RADIANS': 1 };

/** The columns of a bone in a row: the first one and their number. */
interface Columns {
  readonly at: number;
  readonly count: number;
}

/** Returns the columns by bone: the root, then bones with degrees of freedom. */
function columnsOf({ rootFreedoms, bones }: AsfSkeleton): {
  readonly columns: Map<string, Columns>;
  readonly width: number;
} {
  const columns = new Map([['root', { at: 0, count: rootFreedoms.length }]]);
  let width = rootFreedoms.length;
  for (const { name, freedoms } of bones) {
    if (freedoms.length === 0) continue;
    columns.set(name, { at: width, count: freedoms.length });
    width += freedoms.length;
  }
  return { columns, width };
}

/**
 * Reads the text of an AMC file of a skeleton, which lies in the file of this name. Yields the fraction [0, 1] that was
 * read. Throws a sentence with line and column where the text is none, or of another skeleton.
 */
export function* readAmc(text: string, skeleton: AsfSkeleton, skeletonName: string): Generator<number, ImportedMotion> {
  const lines: Lines = new Lines(text);
  const { columns, width } = columnsOf(skeleton);
  const rows = new Rows(width);
  const seen = new Set<string>();
  let at = -1;
  let radians = skeleton.radiansPerUnit;
  const close = (): void => {
    if (at < 0 || seen.size === columns.size) return;
    const missing = [...columns.keys()].find((name) => !seen.has(name))!;
    lines.fail(1, `frame ${rows.count} ends without ${shown(missing)}`);
  };
  while (lines.next()) {
    const { line } = lines;
    const begin = line.search(/\S/);
    const found = /\S+/.exec(line)![0];
    if (found.startsWith(':')) {
      radians = radiansPerUnit[found.toUpperCase()] ?? radians;
      continue;
    }
    if (/^\s*\d+\s*$/.test(line)) {
      close();
      at = rows.add();
      seen.clear();
      if (rows.count % framesPerStep === 0) yield lines.fraction;
      continue;
    }
    const bone = columns.get(found);
    if (!bone || at < 0) lines.fail(begin + 1, `${shown(found)} is no bone with freedom in ${skeletonName}`);
    const count = lines.numbers(begin + found.length, rows.values, at + bone.at, bone.count);
    if (count !== bone.count) lines.fail(begin + 1, `${found} has ${count} numbers, its skeleton says ${bone.count}`);
    seen.add(found);
  }
  close();
  if (rows.count === 0) lines.fail(1, 'no frames');
  return motionOf(new Player(skeleton, radians), skeleton, rows);
}

function motionOf(player: Player, skeleton: AsfSkeleton, { count, width, values }: Rows): ImportedMotion {
  const { bones } = skeleton;
  const names = ['root', ...bones.map(({ name }) => name), ...bones.map(({ name }) => `${name}:end`)];
  const parents = [-1, ...bones.map(({ parent }) => 1 + parent), ...bones.map((_, bone) => 1 + bone)];
  const rest = player
    .pose(new Float64Array(width), 0, createSkeletonPose(names.length))
    .positions.map((position) => subtract(position, skeleton.rootPosition));
  return {
    ...{ names, parents, rest, rateHz: null, frameCount: count, notes: [] },
    pose: (frame, target) => player.pose(values, frame * width, target),
  };
}

/**
 * The forward kinematics of a skeleton: a bone's rotation in its parent is C·M·C⁻¹ with the bone's axes C and the
 * motion's angles M.
 */
class Player {
  readonly #skeleton: AsfSkeleton;
  readonly #radiansPerUnit: number;
  readonly #angles = vec3(0, 0, 0);
  readonly #turn = quat(0, 0, 0, 1);
  readonly #back = quat(0, 0, 0, 1);

  constructor(skeleton: AsfSkeleton, radiansPerUnit: number) {
    this.#skeleton = skeleton;
    this.#radiansPerUnit = radiansPerUnit;
  }

  /** Writes the root, the starts of the bones and their ends, from the numbers that begin at `column`. */
  pose(values: Float64Array, column: number, target: SkeletonPose): SkeletonPose {
    const { bones, rootFreedoms, rootAxis, rootPosition } = this.#skeleton;
    const { positions, rotations } = target;
    this.#turnBy(values, column, rootFreedoms, rootAxis, rotations[0]!);
    add(this.#placeBy(values, column, rootFreedoms, positions[0]!), rootPosition, positions[0]!);
    let next = column + rootFreedoms.length;
    for (let i = 0; i < bones.length; i++) {
      const { parent, way, axis, freedoms } = bones[i]!;
      // A bone of the root begins where the root is, others where their parent ends.
      const start = positions[parent < 0 ? 0 : 1 + bones.length + parent]!;
      const rotation = rotations[1 + i]!;
      this.#turnBy(values, next, freedoms, axis, rotation);
      next += freedoms.length;
      multiply(rotations[1 + parent]!, rotation, rotation);
      copyVec3(start, positions[1 + i]!);
      const end = positions[1 + bones.length + i]!;
      add(start, rotate(rotation, way, end), end);
      copyQuat(rotation, rotations[1 + bones.length + i]!);
    }
    return target;
  }

  #turnBy(values: Float64Array, column: number, freedoms: readonly string[], axis: Quat, target: MutableQuat): void {
    const angles = setVec3(this.#angles, 0, 0, 0);
    let order = '';
    for (let i = 0; i < freedoms.length; i++) {
      const freedom = freedoms[i]!;
      if (freedom !== 'rx' && freedom !== 'ry' && freedom !== 'rz') continue;
      const about = freedom[1] as 'x' | 'y' | 'z';
      angles[about] = values[column + i]! * this.#radiansPerUnit;
      order += about;
    }
    if (order === '') setQuat(target, 0, 0, 0, 1);
    else multiply(axis, multiply(fromEuler(angles, order, this.#turn), conjugate(axis, this.#back), target), target);
  }

  #placeBy(values: Float64Array, column: number, freedoms: readonly string[], target: MutableVec3): MutableVec3 {
    setVec3(target, 0, 0, 0);
    for (let i = 0; i < freedoms.length; i++) {
      const freedom = freedoms[i]!;
      if (freedom === 'tx' || freedom === 'ty' || freedom === 'tz')
        target[freedom[1] as 'x' | 'y' | 'z'] = values[column + i]!;
    }
    return target;
  }
}
