import { fromAxisAngle, type MutableQuat, multiply, type Quat, quat } from '../math/quat';
import { normalise, readVec3, scale, type Vec3, zero } from '../math/vec3';
import { unitAxes } from './imported-motion';
import { Lines, shown, type Word } from './lines';

/** A bone at rest, which starts at the end of its parent; in the file's unit and axes. */
interface AsfBone {
  readonly name: string;
  /** The vector from its start to its end. */
  readonly way: Vec3;
  /** The orientation of the axes of its angles. */
  readonly axis: Quat;
  /** Its degrees of freedom in an AMC file, in order, such as `rx`. */
  readonly freedoms: readonly string[];
  /** The index of the parent among the bones; −1: the root. */
  readonly parent: number;
}

/** An Acclaim skeleton. */
export interface AsfSkeleton {
  /** Parents before children. */
  readonly bones: readonly AsfBone[];
  /** The root's degrees of freedom in an AMC file, in order, such as `tx`. */
  readonly rootFreedoms: readonly string[];
  readonly rootAxis: Quat;
  readonly rootPosition: Vec3;
  /** The unit of the file's angles, and of an AMC file that states none. */
  readonly radiansPerUnit: number;
}

/** The largest number of bones of a human skeleton. */
const maxBones = 2000;
const turn = quat(0, 0, 0, 1);

/** Writes the rotation by angles [rad] about x, y and z, applied in this order (“xyz”: R = Rz·Ry·Rx). */
export function fromEuler(angles: Vec3, order: string, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  target.x = target.y = target.z = 0;
  target.w = 1;
  for (const axis of order) {
    if (axis !== 'x' && axis !== 'y' && axis !== 'z') continue;
    multiply(fromAxisAngle(unitAxes[axis], angles[axis], turn), target, target);
  }
  return target;
}

/** A bone as in :bonedata; angles in the file's unit. */
interface RawBone {
  readonly name: string;
  readonly way: Vec3;
  readonly angles: Vec3;
  readonly order: string;
  readonly freedoms: readonly string[];
}

type Block = Map<string, readonly Word[]>;

/** The contents of a file before its bones are ordered. */
class Sections {
  radiansPerUnit = Math.PI / 180;
  readonly root: Block = new Map();
  readonly bones = new Map<string, RawBone>();
  /** Parents by child. */
  readonly parents = new Map<string, string>();
  readonly #lines: Lines;
  #block: Block | null = null;

  constructor(lines: Lines) {
    this.#lines = lines;
    let section = '';
    while (lines.next()) {
      const words = lines.words(true);
      const first = words[0]?.word;
      if (first === undefined) continue;
      if (first.startsWith(':')) section = first;
      else this.#take(section, first, words);
    }
    if (this.bones.size === 0) lines.fail(1, 'no :bonedata with bones, so this is no ASF skeleton');
  }

  #take(section: string, first: string, words: readonly Word[]): void {
    if (section === ':units' && first === 'angle') this.radiansPerUnit = radiansPerAngle(this.#lines, words);
    else if (section === ':root') this.root.set(first, words);
    else if (section === ':bonedata') this.#takeBone(first, words);
    else if (section === ':hierarchy' && first !== 'begin' && first !== 'end')
      for (const { word } of words.slice(1)) this.parents.set(word, first);
  }

  #takeBone(first: string, words: readonly Word[]): void {
    if (first === 'begin') this.#block = new Map();
    else if (first === 'end') {
      const bone = rawBone(this.#lines, words[0]!, this.#block);
      this.bones.set(bone.name, bone);
      this.#block = null;
      if (this.bones.size > maxBones) this.#lines.fail(1, `more than ${maxBones} bones: not a human skeleton`);
    } else if (['direction', 'length', 'axis'].includes(first)) {
      this.#block?.set(first, words);
      numbersOf(this.#lines, words, first === 'length' ? 1 : 3);
    } else this.#block?.set(first, words);
  }
}

/** Returns the unit [rad] of a skeleton's angles. */
function radiansPerAngle(lines: Lines, [keyword, unit]: readonly Word[]): number {
  if (!unit) return lines.fail(keyword!.column, 'angle should have a unit, deg or rad');
  if (/^deg/i.test(unit.word)) return Math.PI / 180;
  if (/^rad/i.test(unit.word)) return 1;
  return lines.fail(unit.column, `angles are in deg or rad, not in ${shown(unit.word)}`);
}

/** Returns the first `count` numbers after a keyword. */
function numbersOf(lines: Lines, words: readonly Word[], count: number): number[] {
  const given = words.slice(1, 1 + count);
  const { word, column } = words[0]!;
  if (given.length < count) lines.fail(column, `${word} should have ${count} numbers, has ${given.length}`);
  return given.map((each) => lines.numberOf(each));
}

function rawBone(lines: Lines, at: Word, block: Block | null): RawBone {
  const name = block?.get('name')?.[1]?.word;
  if (!block || name === undefined) return lines.fail(at.column, 'a bone without a name ends here');
  const numbers = (key: string, count: number): number[] =>
    numbersOf(lines, block.get(key) ?? lines.fail(at.column, `the bone ${shown(name)} has no ${key}`), count);
  const [length] = numbers('length', 1);
  const axis = block.get('axis');
  return {
    name,
    way: scale(normalise(readVec3(numbers('direction', 3), 0), zero), length!),
    angles: axis ? readVec3(numbersOf(lines, axis, 3), 0) : zero,
    order: axis?.[4]?.word.toLowerCase() ?? 'xyz',
    freedoms: (block.get('dof') ?? []).slice(1).map(({ word }) => word.toLowerCase()),
  };
}

/** Returns the bones, parents before children, without those that the hierarchy does not name. */
function orderedBones({ bones, parents, radiansPerUnit }: Sections): readonly AsfBone[] {
  for (const child of parents.keys())
    if (!bones.has(child)) throw new Error(`the hierarchy names ${shown(child)}, but :bonedata has no such bone`);
  const ordered: AsfBone[] = [];
  const placed = new Map([['root', -1]]);
  let remaining = [...bones.values()].filter(({ name }) => parents.has(name));
  while (remaining.length > 0) {
    const ready = remaining.filter(({ name }) => placed.has(parents.get(name)!));
    if (ready.length === 0)
      throw new Error(`the hierarchy does not lead from the root to ${shown(remaining[0]!.name)}`);
    for (const { name, way, angles, order, freedoms } of ready) {
      const axis = fromEuler(scale(angles, radiansPerUnit), order);
      ordered.push({ name, way, axis, freedoms, parent: placed.get(parents.get(name)!)! });
      placed.set(name, ordered.length - 1);
    }
    remaining = remaining.filter(({ name }) => !placed.has(name));
  }
  return ordered;
}

/**
 * Reads the text of an ASF file. Throws a sentence, where a line is wrong with line and column, where the text is none.
 */
export function readAsf(text: string): AsfSkeleton {
  const lines = new Lines(text);
  const sections = new Sections(lines);
  const { root, radiansPerUnit } = sections;
  const rootVector = (key: string): Vec3 => {
    const words = root.get(key);
    return words ? readVec3(numbersOf(lines, words, 3), 0) : zero;
  };
  const order = (root.get('order') ?? []).slice(1).map(({ word }) => word.toLowerCase());
  return {
    bones: orderedBones(sections),
    rootFreedoms: order.length > 0 ? order : ['tx', 'ty', 'tz', 'rx', 'ry', 'rz'],
    rootAxis: fromEuler(
      scale(rootVector('orientation'), radiansPerUnit),
      root.get('axis')?.[1]?.word.toLowerCase() ?? 'xyz',
    ),
    rootPosition: rootVector('position'),
    radiansPerUnit,
  };
}
