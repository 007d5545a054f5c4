import { button, createStatusLine, element, fileButton, toggle } from 'threepoint-ui';
import type { PanelActions } from './panel-actions';
import type { ExportChoice, ExportState, PanelPage, PanelState, RecorderState } from './panel-state';

const seconds = (value: number): string => `${value.toFixed(1)} s`;

/** What the recorder is doing, in words, and how long it has. */
export function recorderText({ mode, name, seconds: passed, duration }: RecorderState): readonly [string, string] {
  if (mode === 'recording') return ['Recording', `, ${seconds(passed)}`];
  if (mode === 'replaying') return [`Replaying ${name ?? ''}`, `, ${seconds(passed)} of ${seconds(duration)}`];
  return [name ? `${name}, ${seconds(duration)}` : 'Nothing recorded yet.', ''];
}

const about =
  'Records tracking in full precision on this device. Every estimator can replay every recording. Motion capture (BVH, ASF with AMC, VRM Animation) is shown with its ground truth.';

function createRecorderSection(actions: PanelActions) {
  const record = button('Record', () => actions.record(), { class: 'record' });
  const stop = button('Stop', () => actions.stop());
  const replay = button('Replay', () => actions.replay());
  const download = button('Download', () => actions.download());
  const text = createStatusLine({ class: 'recorder-text' });
  const slider = element('input', { type: 'range', min: 0, step: 0.01, 'aria-label': 'Second of the replay' });
  slider.addEventListener('input', () => actions.seek(slider.valueAsNumber));
  const pause = button('Pause', () => actions.setPaused(pause.textContent === 'Pause'));
  const loop = toggle('Loop', (on) => actions.setLoop(on));
  const open = fileButton('Open recording', '.json,application/json', (files) => actions.openFiles(files));
  const openMocap = fileButton(
    'Open motion capture',
    '.bvh,.asf,.amc,.vrma,.fbx,.glb,.gltf,.json',
    (files) => actions.openMotion(files),
    {
      multiple: true,
    },
  );
  return {
    node: element(
      'section',
      {},
      element('h2', {}, 'Recorder'),
      element('p', { class: 'hint' }, about),
      element('div', { class: 'row' }, record, stop, replay, download),
      text.node,
      element('div', { class: 'row timeline' }, pause, slider),
      loop.node,
      element('div', { class: 'row' }, ...open, ...openMocap),
    ),
    show(recorder: RecorderState) {
      const { mode, name, duration } = recorder;
      record.disabled = mode === 'recording';
      stop.disabled = mode === 'idle';
      replay.disabled = mode === 'recording' || name === null;
      download.disabled = mode === 'recording' || name === null;
      for (const node of [pause, slider]) node.hidden = mode !== 'replaying';
      pause.textContent = recorder.paused ? 'Play' : 'Pause';
      slider.max = String(duration);
      slider.value = String(recorder.seconds);
      text.show(...recorderText(recorder));
      loop.input.checked = recorder.loop;
    },
  };
}

const exportChoices: readonly (readonly [ExportChoice, label: string, title: string])[] = [
  ['bvh', 'BVH', 'For Blender, MotionBuilder and others, in metres'],
  ['bvh-cm', 'BVH in cm', 'The same file in centimetres'],
  ['vrma', 'VRM Animation', 'A .vrma, for any VRM avatar'],
  ['glb', 'Avatar (GLB)', 'The current avatar, animated'],
  ['csv', 'Table (CSV)', 'The position of every joint [m], a row per frame'],
];

/** How far a file is, in words. */
const exportText = ({ name, method, fraction, secondsLeft }: ExportState): string => {
  const left = secondsLeft === null ? '' : `, ${Math.ceil(secondsLeft)} s left`;
  return `${name} as drawn by ${method}: ${Math.floor(100 * fraction)}\u00a0%${left}`;
};

/** Files for other programs. */
function createExportSection(actions: PanelActions) {
  const choices = exportChoices.map(([choice, label, title]) =>
    button(label, () => actions.exportMotion(choice), { title }),
  );
  const text = element('p', { class: 'recorder-text' });
  const bar = element('progress', { max: 1, value: 0, 'aria-label': 'Progress of the export' });
  const cancel = button('Cancel export', () => actions.cancelExport());
  const row = element('div', { class: 'row', role: 'group', 'aria-label': 'Export as' }, ...choices);
  return {
    node: element(
      'section',
      {},
      element('h2', {}, 'Export'),
      element(
        'p',
        { class: 'hint' },
        'Exports the current recording with the body that the chosen method estimates, including fingers. Legs are not measured.',
      ),
      row,
      text,
      bar,
      cancel,
    ),
    show({ recorder: { mode, name }, exporting }: PanelState) {
      for (const choice of choices) choice.disabled = mode === 'recording' || name === null || exporting !== null;
      for (const node of [text, bar, cancel]) node.hidden = exporting === null;
      bar.value = exporting?.fraction ?? 0;
      text.textContent = exporting ? exportText(exporting) : '';
    },
  };
}

/** Chooses what moves the body while no headset is worn. */
function createMovers(actions: PanelActions) {
  const actor = toggle('Actor moves the body', (on) => actions.setActor(on));
  const emulatorPanel = toggle('Emulator controls', (on) => actions.setEmulatorPanel(on));
  return {
    node: element('section', {}, element('h2', {}, 'Who moves'), actor.node, emulatorPanel.node),
    show(state: PanelState) {
      actor.input.checked = state.actor;
      emulatorPanel.input.checked = state.emulatorPanel;
      emulatorPanel.node.hidden = !state.emulated;
    },
  };
}

/** Recordings, and what moves the body instead of a person. */
export function createRecordingPage(actions: PanelActions): PanelPage {
  const recorder = createRecorderSection(actions);
  const exports = createExportSection(actions);
  const movers = createMovers(actions);
  return {
    name: 'Recording',
    content: [recorder.node, exports.node, movers.node],
    show(state) {
      recorder.show(state.recorder);
      exports.show(state);
      movers.show(state);
    },
  };
}
