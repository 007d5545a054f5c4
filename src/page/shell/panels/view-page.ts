import { button, element, toggle } from 'threepoint-ui';
import { type ViewName, viewNames } from '../../scene/desktop-view';
import { estimatorOrder } from '../session/estimator-texts';
import type { PanelActions } from './panel-actions';
import type { PanelPage } from './panel-state';

const viewTexts: Readonly<Record<ViewName, string>> = {
  'third-person': 'Behind',
  front: 'Front',
  'first-person': 'Own eyes',
};

const keys: readonly (readonly [string, string])[] = [
  [`1 – ${estimatorOrder.length}`, 'how the body moves'],
  ['V', 'next view'],
  ['C', 'calibrate'],
  ['R', 'centre'],
  ['M', 'mirror'],
  ['B', 'skeleton'],
  ['U', 'upper body only'],
  ['O', 'frame times'],
  ['T', 'mute, in voices'],
  ['P', 'this panel'],
  ['Arrows, + −', 'camera, with the picture focused'],
];

const keysSection = (on: HTMLElement): HTMLElement =>
  element(
    'section',
    {},
    element('h2', {}, 'Keys'),
    on,
    element(
      'dl',
      { class: 'keys' },
      ...keys.flatMap(([key, what]) => [element('dt', {}, key), element('dd', {}, what)]),
    ),
  );

/** Returns what is known of the headset's frame rate, as a line. */
function rateText(rateHz: number, ratesHz: readonly number[]): string {
  const now = `Frame rate: ${Math.round(rateHz)} Hz`;
  if (ratesHz.length === 0) return `${now}.`;
  return `${now}, the highest that the page holds of ${ratesHz.map((rate) => Math.round(rate)).join(', ')} Hz.`;
}

/** The camera, and what it shows in addition to the body. */
export function createViewPage(actions: PanelActions): PanelPage {
  const views = viewNames.map((view) => ({
    view,
    node: button(viewTexts[view], () => actions.chooseView(view), { 'aria-pressed': 'false' }),
  }));
  const mirror = toggle('Mirror', (mirror) => actions.keep({ mirror }));
  const skeleton = toggle('Skeleton', (debugSkeleton) => actions.change({ debugSkeleton }));
  const overlay = toggle('Frame times', (overlay) => actions.keep({ overlay }));
  const largerText = toggle('Larger text', (largerText) => actions.keep({ largerText }));
  const singleKeys = toggle('Single keys', (singleKeys) => actions.keep({ singleKeys }));
  const rate = element('p', { class: 'hint' });
  const camera = element(
    'section',
    {},
    element('h2', {}, 'Camera'),
    element('div', { class: 'segments', role: 'group', 'aria-label': 'Camera' }, ...views.map(({ node }) => node)),
    ...[mirror, skeleton, overlay, largerText].map(({ node }) => node),
    rate,
  );
  return {
    name: 'View',
    content: [camera, keysSection(singleKeys.node)],
    show(state) {
      for (const { view, node } of views) node.setAttribute('aria-pressed', String(view === state.view));
      mirror.input.checked = state.mirror;
      skeleton.input.checked = state.debugSkeleton;
      overlay.input.checked = state.overlay;
      largerText.input.checked = state.largerText;
      singleKeys.input.checked = state.singleKeys;
      rate.hidden = state.rateHz === null;
      rate.textContent = state.rateHz === null ? '' : rateText(state.rateHz, state.ratesHz);
    },
  };
}
