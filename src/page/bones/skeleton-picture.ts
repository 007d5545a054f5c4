import { childrenOf } from 'threepoint/core/math/tree';
import { element } from 'threepoint-ui/element';
import { type BoneChoices, isNeeded, labelOfPart } from './bone-choices';
import { pictureSize, SkeletonView } from './skeleton-view';

type SvgName = 'svg' | 'g' | 'path' | 'circle';

function svg<Name extends SvgName>(name: Name, attributes: Readonly<Record<string, string | number>>) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [attribute, value] of Object.entries(attributes)) node.setAttribute(attribute, String(value));
  return node;
}

const steps: Readonly<Record<string, number>> = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 };

/** Draws a skeleton as a list of its bones: a tap or the arrow keys choose one. */
export function createSkeletonPicture(
  choices: BoneChoices,
  onChoose: (joint: number) => void,
): { readonly node: HTMLElement; show(chosen: number | null): void } {
  const { joints } = choices;
  const selectable = joints.flatMap((_, joint) => (choices.canChoose(joint) ? [joint] : []));
  // A bone reaches from its joint to the next ones.
  const ends = childrenOf(joints.map(({ parent }) => parent));
  const view = new SkeletonView(joints, choices.pairs);
  let chosen: number | null = null;
  const picture = svg('svg', {
    viewBox: `0 0 ${pictureSize} ${pictureSize}`,
    role: 'listbox',
    'aria-label': 'Bones of the file',
  });
  const drawn = joints.map((_, joint) => {
    const [line, dot] = [svg('path', {}), svg('circle', { r: 4 })];
    const node = svg('g', choices.canChoose(joint) ? { role: 'option' } : { 'aria-hidden': 'true' });
    node.append(line, dot);
    return { node, line, dot };
  });
  picture.append(...drawn.map(({ node }) => node));
  const whole = element('button', { type: 'button', class: 'quiet' }, 'Whole body');
  const node = element('div', { class: 'skeleton' }, picture, whole);

  function show(joint: number | null): void {
    // A picture that was zoomed stays where it is.
    if (joint !== null && joint !== chosen) view.reveal(joint);
    chosen = joint;
    whole.hidden = !view.isZoomed;
    const tabStop = chosen ?? selectable[0];
    for (const [i, { node, line, dot }] of drawn.entries()) {
      const { x, y } = view.place(i);
      const lines = ends[i]!.map((end) => `M${x} ${y}L${view.place(end).x} ${view.place(end).y}`);
      line.setAttribute('d', lines.join(''));
      dot.setAttribute('cx', String(x));
      dot.setAttribute('cy', String(y));
      node.setAttribute('class', stateOf(i));
      if (!choices.canChoose(i)) continue;
      const part = choices.partOf(i);
      const what = part ? `${labelOfPart(part)}${choices.isUnsure(i) ? ', a guess' : ''}` : 'no part of the body';
      node.setAttribute('aria-label', `${choices.fileNameOf(i)}: ${what}`);
      node.setAttribute('aria-selected', String(i === chosen));
      node.setAttribute('tabindex', i === tabStop ? '0' : '-1');
    }
  }

  const stateOf = (joint: number): string => {
    const part = choices.partOf(joint);
    const state = part === null ? 'none' : choices.isUnsure(joint) ? 'unsure' : 'sure';
    return [state, part && isNeeded(part) && 'needed', joint === chosen && 'chosen'].filter(Boolean).join(' ');
  };

  function choose(joint: number): void {
    onChoose(joint);
    drawn[joint]!.node.focus({ preventScroll: true });
  }

  picture.addEventListener('click', ({ clientX, clientY, target, detail }) => {
    const own = drawn.findIndex(({ node }) => node.contains(target as Node));
    // A click without a pointer, as from a screen reader, is at no place.
    if (detail === 0 && own >= 0) return choose(own);
    const { left, top, width } = picture.getBoundingClientRect();
    const scale = pictureSize / width;
    const joint = view.pick({ x: (clientX - left) * scale, y: (clientY - top) * scale }, selectable, chosen);
    if (joint === null) show(chosen);
    else choose(joint);
  });
  picture.addEventListener('keydown', (event) => {
    const at = chosen === null ? -1 : selectable.indexOf(chosen);
    const step = steps[event.key];
    const jumps: Readonly<Record<string, number>> = { Home: 0, End: selectable.length - 1 };
    const next = step === undefined ? jumps[event.key] : at + step;
    if (next === undefined) return;
    event.preventDefault();
    const joint = selectable[Math.min(Math.max(next, 0), selectable.length - 1)];
    if (joint !== undefined) choose(joint);
  });
  whole.addEventListener('click', () => {
    view.showWhole();
    show(chosen);
  });
  show(null);
  return { node, show };
}
