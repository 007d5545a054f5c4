import { element } from 'threepoint-ui';
import { height, type Target, width } from '../questions/sheet-target';
import type { StudyScreen } from '../questions/study-screen';
import { paintSheet, targetsOf } from '../sheet/study-sheet';

const within = ({ at: [left, top, wide, high] }: Target, x: number, y: number) =>
  x >= left && x < left + wide && y >= top && y < top + high;

/** Returns the sheet of the headset on a flat page, drawn by the same code and pressed with the mouse. */
export function createDrawnSheet() {
  const node = element('canvas', { class: 'drawn-sheet', width, height, role: 'img' });
  const context = node.getContext('2d');
  if (!context) throw new Error('The sheet of the headset cannot be drawn: this browser offers no 2D canvas.');
  let screen: StudyScreen | null = null;
  let targets: readonly Target[] = [];
  let hovered: string | null = null;

  const paint = () => {
    context.clearRect(0, 0, width, height);
    if (screen) paintSheet(context, screen, { targets, hovered });
  };
  const under = ({ offsetX, offsetY }: MouseEvent): Target | undefined => {
    const x = (offsetX / node.clientWidth) * width;
    const y = (offsetY / node.clientHeight) * height;
    return targets.find((target) => target.look !== 'off' && within(target, x, y));
  };
  const hover = (target: Target | undefined) => {
    node.style.cursor = target ? 'pointer' : '';
    if ((target?.id ?? null) === hovered) return;
    hovered = target?.id ?? null;
    paint();
  };
  node.addEventListener('mousemove', (event) => hover(under(event)));
  node.addEventListener('mouseleave', () => hover(undefined));
  node.addEventListener('click', (event) => {
    under(event)?.act();
    hover(under(event));
  });
  return {
    node,
    /** null hides it. */
    show(shown: StudyScreen | null): void {
      screen = shown;
      node.hidden = shown === null;
      targets = shown ? targetsOf(shown) : [];
      if (shown) node.lang = shown.phrases.locale;
      if (shown) node.ariaLabel = `In the headset: ${[shown.kicker, shown.title, ...shown.text].join('. ')}`;
      paint();
    },
  };
}
