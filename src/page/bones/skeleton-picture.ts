import { childrenOf } from 'threepoint/math';
import { button, element } from 'threepoint-ui';
import { type BoneChoices, isNeeded, labelOfPart } from './bone-choices';
import { type Point, pictureSize, SkeletonView } from './skeleton-view';

type SvgName = 'svg' | 'g' | 'path' | 'circle';

function svg<Name extends SvgName>(name: Name, attributes: Readonly<Record<string, string | number>>) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [attribute, value] of Object.entries(attributes)) node.setAttribute(attribute, String(value));
  return node;
}

/** The steps of the arrow keys through the list of bones. */
const arrowSteps: Readonly<Record<string, number>> = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 };

/** Returns the index in a list of this length that a key selects, from the current index; null: another key. */
function indexForKey(key: string, current: number, length: number): number | null {
  if (key === 'Home') return 0;
  if (key === 'End') return length - 1;
  const step = arrowSteps[key];
  return step === undefined ? null : Math.min(Math.max(current + step, 0), length - 1);
}

/** Draws one bone: a dot at its joint and lines to the next joints. */
function createBone(choices: BoneChoices, joint: number) {
  const isSelectable = choices.canChoose(joint);
  const [line, dot] = [svg('path', {}), svg('circle', { r: 4 })];
  const node = svg('g', isSelectable ? { role: 'option' } : { 'aria-hidden': 'true' });
  node.append(line, dot);
  return {
    node,
    place({ x, y }: Point, ends: readonly Point[]): void {
      line.setAttribute('d', ends.map((end) => `M${x} ${y}L${end.x} ${end.y}`).join(''));
      dot.setAttribute('cx', String(x));
      dot.setAttribute('cy', String(y));
    },
    /** Shows the part of the body that the bone is. `isTabStop`: the Tab key focuses this bone of the list. */
    describe(isChosen: boolean, isTabStop: boolean): void {
      const part = choices.partOf(joint);
      const isUnsure = choices.isUnsure(joint);
      const state = part === null ? 'none' : isUnsure ? 'unsure' : 'sure';
      const classes = [state, part && isNeeded(part) && 'needed', isChosen && 'chosen'];
      node.setAttribute('class', classes.filter(Boolean).join(' '));
      if (!isSelectable) return;
      const label = part ? `${labelOfPart(part)}${isUnsure ? ', a guess' : ''}` : 'no part of the body';
      node.setAttribute('aria-label', `${choices.fileNameOf(joint)}: ${label}`);
      node.setAttribute('aria-selected', String(isChosen));
      node.setAttribute('tabindex', isTabStop ? '0' : '-1');
    },
  };
}

/** Draws a skeleton as a list of its bones. A tap or the arrow keys choose one. */
export function createSkeletonPicture(choices: BoneChoices, onChoose: (joint: number) => void) {
  const { joints } = choices;
  const selectable = joints.flatMap((_, joint) => (choices.canChoose(joint) ? [joint] : []));
  // A bone reaches from its joint to the next ones.
  const ends = childrenOf(joints.map(({ parent }) => parent));
  const view = new SkeletonView(joints, choices.pairs);
  let chosen: number | null = null;
  const bones = joints.map((_, joint) => createBone(choices, joint));
  const picture = svg('svg', {
    viewBox: `0 0 ${pictureSize} ${pictureSize}`,
    role: 'listbox',
    'aria-label': 'Bones of the file',
  });
  picture.append(...bones.map(({ node }) => node));
  const whole = button('Whole body', () => showWhole(), { class: 'quiet' });

  function show(joint: number | null): void {
    // A picture that was zoomed stays where it is.
    if (joint !== null && joint !== chosen) view.reveal(joint);
    chosen = joint;
    whole.hidden = !view.isZoomed;
    const tabStop = chosen ?? selectable[0];
    for (const [i, bone] of bones.entries()) {
      bone.place(
        view.place(i),
        ends[i]!.map((end) => view.place(end)),
      );
      bone.describe(i === chosen, i === tabStop);
    }
  }

  function showWhole(): void {
    view.showWhole();
    show(chosen);
  }

  function choose(joint: number): void {
    onChoose(joint);
    bones[joint]!.node.focus({ preventScroll: true });
  }

  picture.addEventListener('click', ({ clientX, clientY, target, detail }) => {
    const clicked = bones.findIndex(({ node }) => node.contains(target as Node));
    // A click without a pointer, as from a screen reader, has no position.
    if (detail === 0 && clicked >= 0) return choose(clicked);
    const { left, top, width } = picture.getBoundingClientRect();
    const scale = pictureSize / width;
    const joint = view.pick({ x: (clientX - left) * scale, y: (clientY - top) * scale }, selectable, chosen);
    if (joint === null) show(chosen);
    else choose(joint);
  });
  picture.addEventListener('keydown', (event) => {
    const current = chosen === null ? -1 : selectable.indexOf(chosen);
    const next = indexForKey(event.key, current, selectable.length);
    if (next === null) return;
    event.preventDefault();
    const joint = selectable[next];
    if (joint !== undefined) choose(joint);
  });
  show(null);
  return { node: element('div', { class: 'skeleton' }, picture, whole), show };
}
