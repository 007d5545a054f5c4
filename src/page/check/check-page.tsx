import { render } from 'preact';
import type { WebGLRenderer } from 'three';
import { createPageClock, firstLine, type PageClock, reasonOf, TrackingDegradation } from 'threepoint/core';
import { describeXrSupport } from 'threepoint/internal';
import { BodyTracker } from 'threepoint/three';
import { createEnterButton, installTrustedTypesPolicy, pageElement } from 'threepoint-ui';
import { Complaint } from 'threepoint-ui/controls';
import { type Emulator, installEmulator } from '../emulator/emulator';
import { createEmulatorBar } from '../emulator/emulator-bar';
import { affordableQuality, createRenderer, fitToWindow } from '../scene/renderer';
import { FrameTiming } from '../shell/session/frame-timing';
import { createNetworkLoader } from '../shell/session/network-loading';
import { fetchBuiltInAvatar } from '../shell/stage/avatar-loader';
import type { CheckStep } from './check-steps';
import { readCheckSwitches } from './check-switches';
import { CheckWorlds } from './check-worlds';
import { HeadsetCheck } from './headset-check';
import { ResultCard } from './result-card';

/** The estimators whose networks are loaded before the session; the last one draws first. */
const preloaded = ['paper', 'learned'] as const;

const camerasText = 'This address simulates a headset’s cameras: hands outside their view are lost.';
/** What a visitor without a headset can expect. */
const emulatedText =
  'You can try the check in an emulated headset, which mouse and keys move. It has no sensors: noise, lost hands and ' +
  'latency are not those of a device, and frame times are those of this computer.';

const regions = () => ({
  enter: pageElement('enter', HTMLElement),
  progress: pageElement('progress', HTMLElement),
  caption: pageElement('caption', HTMLElement),
  steps: pageElement('steps', HTMLElement),
  result: pageElement('result', HTMLElement),
  canvas: pageElement('stage', HTMLCanvasElement),
  emulator: pageElement('emulator', HTMLElement),
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
  render(
    titles.map((title) => <li aria-current={title === now.title ? 'step' : undefined}>{title}</li>),
    list,
  );
}

/** Installs the emulator if the address asks for it or there is no headset. Returns the reason as a sentence. */
async function prepareHeadset(
  emulate: boolean,
): Promise<{ readonly emulator: Emulator | null; readonly sentence: string | null }> {
  const support = await describeXrSupport();
  if (support.kind === 'device' && !emulate) return { emulator: null, sentence: null };
  const reason = emulate ? 'The address asks for the emulated headset.' : support.sentence;
  return { emulator: await installEmulator(), sentence: `${reason} ${emulatedText}` };
}

/** Creates the tracker of the user's body and loads its networks. */
async function createTracker(
  renderer: WebGLRenderer,
  clock: PageClock,
  { avatar, scene }: CheckWorlds,
  onProblem: (sentence: string) => void,
) {
  const timing = new FrameTiming(() => performance.now());
  const tracker = new BodyTracker(renderer, {
    avatar,
    clock,
    deviceBody: true,
    estimator: 'ik',
    networks: createNetworkLoader({
      provider: null,
      notices: { show: (_, text) => onProblem(text) },
      loading: { report: () => undefined },
    }),
    profiler: timing,
  });
  scene.add(tracker.object);
  // The report names the estimator that drew.
  tracker.addEventListener('fallback', (event) => {
    event.preventDefault();
    onProblem(`The estimator “${event.estimator}” cannot be measured: ${firstLine(event.reason)}.`);
  });
  for (const name of preloaded) await tracker.setEstimator(name);
  return { tracker, timing };
}

/** Builds the page. Each click on its button starts a new check. */
async function start(): Promise<void> {
  installTrustedTypesPolicy();
  const parts = regions();
  const { canvas, progress, result } = parts;
  const switches = readCheckSwitches(location.search);
  const { pace, emulate, cameras } = switches;
  const quality = switches.quality ?? affordableQuality();
  const renderer = createRenderer(canvas, quality);
  const button = createEnterButton(parts.enter, () => void run());
  const show = (label: string, sentence: string | null, enabled: boolean) =>
    button.show({ label, passthroughLabel: null, sentence, enabled });
  show('Loading …', null, false);
  const [{ emulator, sentence }, mannequin] = await Promise.all([
    prepareHeadset(emulate),
    fetchBuiltInAvatar('mannequin'),
  ]);
  const remarks = [...switches.complaints, ...(cameras ? [camerasText] : []), ...(sentence ? [sentence] : [])];
  const onProblem = (problem: string) => void remarks.push(problem);
  const clock = createPageClock(() => performance.now());
  const worlds = await CheckWorlds.create({ renderer, quality, clock, mannequin, onProblem });
  const { tracker, timing } = await createTracker(renderer, clock, worlds, onProblem);
  const degradation = new TrackingDegradation();
  degradation.configure(cameras ? { cameraView: true } : null);
  let running: HeadsetCheck | null = null;
  const bar = createEmulatorBar(parts.emulator, {
    lookAround: () => emulator?.lookAround(),
    stop: () => running?.stop(),
  });
  const offer = (label: string) => show(label, remarks.join(' ') || null, true);

  async function run(): Promise<void> {
    show('Checking …', null, false);
    result.hidden = true;
    canvas.hidden = false;
    fitToWindow(renderer, quality);
    running = new HeadsetCheck({
      renderer,
      quality,
      worlds,
      tracker,
      degradation,
      timing,
      emulator,
      pace,
      onStep(step, steps) {
        showStep(parts, step, steps);
        if (emulator) bar.show({ actor: false, task: step.sentence });
      },
      onReport(report) {
        bar.show(null);
        progress.hidden = true;
        canvas.hidden = true;
        // Each check has its own card.
        render(<ResultCard key={report} report={report} />, result);
        result.hidden = false;
        result.focus();
        offer('Measure again');
      },
    });
    try {
      await running.start();
    } catch (error) {
      canvas.hidden = true;
      show('Try again', `The check could not start: ${firstLine(reasonOf(error))}.`, true);
    }
  }

  offer(emulator ? 'Start in the emulated headset' : 'Start in the headset');
}

start().catch((error: unknown) => {
  render(
    <Complaint text={`The page could not start: ${firstLine(reasonOf(error))}`} />,
    pageElement('enter', HTMLElement),
  );
});
