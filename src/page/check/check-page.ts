import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import { describeXrSupport } from 'threepoint/xr/session';
import { element, pageElement } from 'threepoint-ui/element';
import { createEnterButton } from 'threepoint-ui/enter-button';
import { allowOwnScripts } from 'threepoint-ui/own-scripts';
import { installEmulator } from '../emulator/emulator';
import { affordableQuality, createRenderer, fitToWindow } from '../scene/renderer';
import { fetchBuiltInAvatar } from '../shell/avatar-loader';
import { createNetworkLoader } from '../shell/network-loading';
import type { CheckStep } from './check-steps';
import { readCheckSwitches } from './check-switches';
import { CheckWorlds } from './check-worlds';
import { HeadsetCheck } from './headset-check';
import { showResultCard } from './result-card';

const regions = () => ({
  enter: pageElement('enter', HTMLElement),
  progress: pageElement('progress', HTMLElement),
  caption: pageElement('caption', HTMLElement),
  steps: pageElement('steps', HTMLElement),
  result: pageElement('result', HTMLElement),
});

/** Lists the steps by title, each once, and marks the one that runs. */
function showStep(
  { caption, steps: list, progress }: ReturnType<typeof regions>,
  now: CheckStep,
  all: readonly CheckStep[],
) {
  progress.hidden = false;
  if (caption.textContent !== now.sentence) caption.textContent = now.sentence;
  const titles = [...new Set(all.map(({ title }) => title))];
  list.replaceChildren(
    ...titles.map((title) => element('li', title === now.title ? { 'aria-current': 'step' } : {}, title)),
  );
}

/** Installs the emulator where it is wanted or no headset is there. Returns why, as a sentence. */
async function prepareHeadset(
  emulate: boolean,
): Promise<{ readonly emulated: boolean; readonly sentence: string | null }> {
  const support = await describeXrSupport();
  if (support.kind === 'device' && !emulate) return { emulated: false, sentence: null };
  await installEmulator();
  const reason = emulate
    ? 'The address asks for the emulated headset'
    : `${support.sentence} An emulated headset takes its place`;
  return { emulated: true, sentence: `${reason}: its figures are no measurement of a device.` };
}

/** Builds the page; each click on the button is a check of its own. */
async function start(): Promise<void> {
  allowOwnScripts();
  const parts = regions();
  const switches = readCheckSwitches(location.search);
  const quality = switches.quality ?? affordableQuality();
  const canvas = pageElement('stage', HTMLCanvasElement);
  const renderer = createRenderer(canvas, quality);
  let ready: Promise<HeadsetCheck>;
  const button = createEnterButton(parts.enter, () => void run());
  const show = (label: string, sentence: string | null, enabled: boolean) =>
    button.show({ label, passthroughLabel: null, sentence, enabled });
  show('Loading …', null, false);
  const [{ emulated, sentence }, file] = await Promise.all([
    prepareHeadset(switches.emulate),
    fetchBuiltInAvatar('mannequin'),
  ]);
  const label = emulated ? 'Start in the emulated headset' : 'Start in the headset';
  const worlds = await CheckWorlds.create(renderer, quality, file);
  const networks = createNetworkLoader({
    provider: 'wasm',
    notices: { show: (_, text) => show(label, text, true) },
    loading: { report: () => undefined },
  });
  const told = [...switches.complaints, ...(sentence ? [sentence] : [])].join(' ') || null;

  async function prepare(): Promise<HeadsetCheck> {
    const check: HeadsetCheck = new HeadsetCheck({
      renderer,
      quality,
      worlds,
      networks,
      emulated,
      pace: switches.pace,
      onStep: (step, steps) => showStep(parts, step, steps),
      onReport(report) {
        parts.progress.hidden = true;
        canvas.hidden = true;
        showResultCard(parts.result, report);
        ready = check.dispose().then(prepare);
        void ready.then(() => show('Check again', told, true));
      },
    });
    await check.load();
    return check;
  }

  async function run(): Promise<void> {
    show('Checking …', null, false);
    parts.result.hidden = true;
    canvas.hidden = false;
    fitToWindow(renderer, quality);
    try {
      await (await ready).start();
    } catch (error) {
      canvas.hidden = true;
      show(label, `The check could not start: ${firstLine(reasonOf(error))}. Try again.`, true);
    }
  }

  ready = prepare();
  await ready;
  show(label, told, true);
}

start().catch((error: unknown) => {
  pageElement('enter', HTMLElement).replaceChildren(
    element('p', { class: 'complaint', role: 'alert' }, `The page could not start: ${firstLine(reasonOf(error))}`),
  );
});
