import { Button, Group, Toggle } from 'threepoint-ui/controls';
import { type ViewName, viewNames } from '../../scene/desktop-view';
import { listedEstimators } from '../session/estimator-texts';
import type { PanelPageProps } from './panel-actions';

const viewTexts: Readonly<Record<ViewName, string>> = {
  'third-person': 'Behind',
  front: 'Front',
  'first-person': 'Your eyes',
};

const keys: readonly (readonly [string, string])[] = [
  [`1 – ${listedEstimators.length}`, 'how the body moves'],
  ['V', 'next view'],
  ['C', 'calibrate'],
  ['R', 'centre'],
  ['M', 'mirror'],
  ['B', 'skeleton'],
  ['U', 'upper body only'],
  ['O', 'frame times'],
  ['T', 'mute yourself in voice chat'],
  ['P', 'this panel'],
  ['Arrows, + −', 'camera, while the picture has the focus'],
];

/** Returns what is known of the headset's frame rate, as a line. */
function rateText(rateHz: number, ratesHz: readonly number[]): string {
  const now = `Frame rate: ${Math.round(rateHz)} Hz`;
  if (ratesHz.length === 0) return `${now}.`;
  return `${now}, the highest that the page holds of ${ratesHz.map((rate) => Math.round(rate)).join(', ')} Hz.`;
}

/** The camera, and what it shows in addition to the body. */
export const ViewPage = ({ state, actions }: PanelPageProps) => (
  <>
    <section>
      <h2>Camera</h2>
      <Group label="Camera" class="segments">
        {viewNames.map((view) => (
          <Button label={viewTexts[view]} aria-pressed={view === state.view} onClick={() => actions.chooseView(view)} />
        ))}
      </Group>
      <Toggle label="Mirror" on={state.mirror} set={(mirror) => actions.keep({ mirror })} />
      <Toggle label="Skeleton" on={state.debugSkeleton} set={(debugSkeleton) => actions.change({ debugSkeleton })} />
      <Toggle label="Frame times" on={state.overlay} set={(overlay) => actions.keep({ overlay })} />
      <Toggle label="Larger text" on={state.largerText} set={(largerText) => actions.keep({ largerText })} />
      {state.rateHz !== null && <p class="hint">{rateText(state.rateHz, state.ratesHz)}</p>}
    </section>
    <section>
      <h2>Keys</h2>
      <Toggle label="Single keys" on={state.singleKeys} set={(singleKeys) => actions.keep({ singleKeys })} />
      <dl class="keys">
        {keys.map(([key, what]) => (
          <>
            <dt>{key}</dt>
            <dd>{what}</dd>
          </>
        ))}
      </dl>
    </section>
    <p class="hint">
      For developers: <a href="./embed.html">a body in your own page</a>, in twenty lines, and{' '}
      <a href="./check.html">a check of your headset</a>.
    </p>
  </>
);
