import type { EstimatorName } from '../../core/estimation/pose-estimator';
import type { ViewName } from '../../scene/desktop-view';
import { button, element } from '../../ui/element';
import { estimatorOrder, estimatorTexts } from './estimator-texts';

/** What the recorder is doing; seconds since its start, of how many. */
export interface RecorderState {
  readonly mode: 'idle' | 'recording' | 'replaying';
  readonly seconds: number;
  readonly duration: number;
  readonly loop: boolean;
  /** Name of the recording at hand; null: none. */
  readonly name: string | null;
}

/** Everything the controls show; they keep no state of their own. */
export interface PanelState {
  readonly estimator: EstimatorName;
  /** Why an estimator is not to be had; absent: it is. */
  readonly unavailable: Partial<Readonly<Record<EstimatorName, string>>>;
  readonly view: ViewName;
  readonly mirror: boolean;
  readonly upperBodyOnly: boolean;
  readonly debugSkeleton: boolean;
  readonly overlay: boolean;
  readonly largerText: boolean;
  readonly avatarName: string;
  /** What became of an avatar that was asked for and is not shown; null: nothing to tell. */
  readonly avatarPending: string | null;
  /** Another avatar than ours is shown, or was wanted. */
  readonly ownAvatarOffered: boolean;
  /** Colours of our own avatar; null: another avatar is shown, which keeps its own. */
  readonly palette: string | null;
  readonly heightCm: number;
  readonly armSpanCm: number;
  readonly eyeHeightCm: number;
  readonly calibrationSource: string;
  readonly actor: boolean;
  readonly emulated: boolean;
  readonly emulatorPanel: boolean;
  readonly recorder: RecorderState;
  readonly inSession: boolean;
}

export interface PanelActions {
  chooseEstimator(name: EstimatorName): void;
  chooseView(view: ViewName): void;
  setMirror(on: boolean): void;
  setUpperBodyOnly(on: boolean): void;
  setDebugSkeleton(on: boolean): void;
  setOverlay(on: boolean): void;
  setLargerText(on: boolean): void;
  choosePalette(name: string): void;
  openAvatarFile(file: File): void;
  openAvatarUrl(url: string): void;
  showOwnAvatar(): void;
  calibrate(): void;
  setMeasures(measures: { readonly heightCm: number; readonly armSpanCm: number }): void;
  resetCalibration(): void;
  setActor(on: boolean): void;
  setEmulatorPanel(on: boolean): void;
  recentre(): void;
  exitVr(): void;
  record(): void;
  stop(): void;
  replay(): void;
  download(): void;
  openRecording(file: File): void;
  setLoop(on: boolean): void;
}

export interface PanelOptions {
  readonly palettes: readonly { readonly name: string; readonly label: string; readonly color: string }[];
  readonly height: { readonly min: number; readonly max: number };
  readonly armSpan: { readonly min: number; readonly max: number };
}

export interface Panel {
  readonly open: boolean;
  setOpen(open: boolean): void;
  show(state: PanelState): void;
}

const viewTexts: Readonly<Record<ViewName, string>> = {
  'third-person': 'Third person',
  front: 'Front',
  'first-person': 'First person',
};

const keys: readonly (readonly [string, string])[] = [
  ['1 – 4', 'estimator'],
  ['V', 'next view'],
  ['C', 'calibrate'],
  ['R', 'recentre'],
  ['M', 'mirror'],
  ['B', 'debug skeleton'],
  ['U', 'upper body only'],
  ['O', 'frame times'],
  ['P', 'this panel'],
  ['Arrows, + −', 'camera, with the picture focused'],
];

/** A labelled switch; the whole row is its target. */
function toggle(label: string, onChange: (on: boolean) => void) {
  const input = element('input', { type: 'checkbox', role: 'switch' });
  input.addEventListener('change', () => onChange(input.checked));
  return { input, node: element('label', { class: 'toggle' }, element('span', {}, label), input) };
}

/** A button that opens a file dialog. */
function fileButton(label: string, accept: string, onFile: (file: File) => void): HTMLElement[] {
  const input = element('input', { type: 'file', accept, hidden: true, 'aria-label': label });
  input.addEventListener('change', () => {
    const [file] = input.files ?? [];
    if (file) onFile(file);
    // The same file again must be a change again.
    input.value = '';
  });
  return [button(label, () => input.click()), input];
}

function seconds(value: number): string {
  return `${value.toFixed(1)} s`;
}

/** Tabs by the book: one in the tab order, arrow keys walk. */
function createTabs(pages: readonly { readonly name: string; readonly content: readonly Node[] }[]): HTMLElement[] {
  const list = element('div', { role: 'tablist', 'aria-label': 'Controls' });
  const tabs = pages.map(({ name }) =>
    element('button', { type: 'button', role: 'tab', id: `tab-${name}`, 'aria-controls': `page-${name}` }, name),
  );
  const panels = pages.map(({ name, content }) =>
    element(
      'div',
      { role: 'tabpanel', id: `page-${name}`, 'aria-labelledby': `tab-${name}`, class: 'page' },
      ...content,
    ),
  );
  const select = (chosen: number) => {
    for (const [index, tab] of tabs.entries()) {
      tab.setAttribute('aria-selected', String(index === chosen));
      tab.tabIndex = index === chosen ? 0 : -1;
      const panel = panels[index];
      if (panel) panel.hidden = index !== chosen;
    }
  };
  for (const [index, tab] of tabs.entries()) {
    tab.addEventListener('click', () => select(index));
    tab.addEventListener('keydown', (event) => {
      const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
      if (step === 0) return;
      event.preventDefault();
      const next = (index + step + tabs.length) % tabs.length;
      select(next);
      tabs[next]?.focus();
    });
  }
  list.append(...tabs);
  select(0);
  return [list, ...panels];
}

/** The controls of the desktop page. They show a state and report wishes; what happens is decided elsewhere. */
export function createPanel(region: HTMLElement, options: PanelOptions, actions: PanelActions): Panel {
  const estimators = estimatorOrder.map((name) => {
    const { label, text } = estimatorTexts[name];
    const input = element('input', {
      type: 'radio',
      name: 'estimator',
      value: name,
      'aria-label': label,
      'aria-describedby': `about-${name}`,
    });
    input.addEventListener('change', () => {
      if (input.checked) actions.chooseEstimator(name);
    });
    const about = element('small', { id: `about-${name}` }, text);
    const node = element('label', { class: 'choice' }, input, element('span', {}, element('b', {}, label), about));
    return { name, input, about, node };
  });

  const views = (Object.keys(viewTexts) as ViewName[]).map((view) => {
    const node = button(viewTexts[view], () => actions.chooseView(view), { 'aria-pressed': 'false' });
    return { view, node };
  });

  const swatches = options.palettes.map(({ name, label, color }) => {
    const node = button('', () => actions.choosePalette(name), { class: 'swatch', 'aria-label': label, title: label });
    node.style.setProperty('--swatch', color);
    return { name, node };
  });

  const measure = (label: string, range: { min: number; max: number }) => {
    const input = element('input', {
      type: 'number',
      inputmode: 'numeric',
      min: Math.round(range.min),
      max: Math.round(range.max),
      step: 1,
      'aria-label': `${label} in centimetres`,
    });
    return {
      input,
      node: element('label', { class: 'measure' }, element('span', {}, label), input, element('i', {}, 'cm')),
    };
  };
  const height = measure('Height', options.height);
  const armSpan = measure('Arm span', options.armSpan);
  const applyMeasures = () => {
    const valid = [height.input, armSpan.input].every((input) => input.reportValidity() && input.value !== '');
    if (valid) actions.setMeasures({ heightCm: height.input.valueAsNumber, armSpanCm: armSpan.input.valueAsNumber });
  };
  height.input.addEventListener('change', applyMeasures);
  armSpan.input.addEventListener('change', applyMeasures);
  const eyeHeight = element('small', { class: 'hint' });

  const mirror = toggle('Mirror', actions.setMirror);
  const upperBody = toggle('Upper body only', actions.setUpperBodyOnly);
  const skeleton = toggle('Debug skeleton', actions.setDebugSkeleton);
  const overlay = toggle('Frame times', actions.setOverlay);
  const largerText = toggle('Larger text', actions.setLargerText);
  const actor = toggle('Actor moves the body', actions.setActor);
  const emulatorPanel = toggle('Emulator controls', actions.setEmulatorPanel);
  const loop = toggle('Loop', actions.setLoop);

  const avatarName = element('p', { class: 'avatar-name' });
  const avatarPending = element('p', { class: 'hint', role: 'status' });
  const ownAvatar = button('Back to ours', actions.showOwnAvatar);
  const url = element('input', {
    type: 'url',
    placeholder: 'https://…/avatar.vrm',
    'aria-label': 'Address of a VRM or GLB',
  });
  const urlForm = element('form', { class: 'row' }, url, element('button', { type: 'submit' }, 'Load'));
  urlForm.addEventListener('submit', (event) => {
    event.preventDefault();
    if (url.value) actions.openAvatarUrl(url.value);
  });

  const record = button('Record', actions.record, { class: 'record' });
  const stop = button('Stop', actions.stop);
  const replay = button('Replay', actions.replay);
  const download = button('Download', actions.download);
  const recorderText = element('p', { class: 'recorder-text', role: 'status' });
  const recorderBar = element('progress', { max: 1, value: 0, 'aria-label': 'Progress of the replay' });

  const body = [
    element(
      'fieldset',
      { class: 'choices' },
      element('legend', {}, 'Estimator'),
      ...estimators.map(({ node }) => node),
    ),
    element(
      'section',
      { class: 'calibration' },
      element('h2', {}, 'Your measures'),
      element('div', { class: 'row' }, height.node, armSpan.node),
      eyeHeight,
      element(
        'div',
        { class: 'row' },
        button('Calibrate', actions.calibrate, { class: 'primary' }),
        button('Reset', actions.resetCalibration, { 'aria-label': 'Reset calibration' }),
      ),
    ),
  ];
  const avatar = [
    element(
      'section',
      {},
      element('h2', {}, 'Avatar'),
      avatarName,
      avatarPending,
      element(
        'div',
        { class: 'swatches', role: 'group', 'aria-label': 'Colours' },
        ...swatches.map(({ node }) => node),
      ),
      ownAvatar,
    ),
    element(
      'section',
      {},
      element('h2', {}, 'Another one'),
      element('p', { class: 'hint' }, 'Any VRM avatar (0.x or 1.0): drop it on the page, or'),
      element('div', { class: 'row' }, ...fileButton('Open VRM file', '.vrm,.glb', actions.openAvatarFile)),
      urlForm,
    ),
    element('section', {}, upperBody.node),
  ];
  const recording = [
    element(
      'section',
      {},
      element('h2', {}, 'Recorder'),
      element(
        'p',
        { class: 'hint' },
        'Keeps what is tracked, in full precision, on this device; any recording replays through any estimator.',
      ),
      element('div', { class: 'row' }, record, stop, replay, download),
      recorderText,
      recorderBar,
      loop.node,
      element(
        'div',
        { class: 'row' },
        ...fileButton('Open recording', '.json,application/json', actions.openRecording),
      ),
    ),
    element('section', {}, element('h2', {}, 'Who moves'), actor.node, emulatorPanel.node),
  ];
  const view = [
    element(
      'section',
      {},
      element('h2', {}, 'Camera'),
      element('div', { class: 'segments', role: 'group', 'aria-label': 'Camera' }, ...views.map(({ node }) => node)),
      mirror.node,
      skeleton.node,
      overlay.node,
      largerText.node,
    ),
    element(
      'section',
      {},
      element('h2', {}, 'Keys'),
      element(
        'dl',
        { class: 'keys' },
        ...keys.flatMap(([key, what]) => [element('dt', {}, key), element('dd', {}, what)]),
      ),
    ),
  ];

  const content = element(
    'div',
    { class: 'panel', id: 'panel' },
    ...createTabs([
      { name: 'Body', content: body },
      { name: 'Avatar', content: avatar },
      { name: 'Recording', content: recording },
      { name: 'View', content: view },
    ]),
  );
  const recentre = button('Recentre', actions.recentre, { class: 'quiet' });
  const exit = button('Exit VR', actions.exitVr, { class: 'quiet' });
  const opener = button('Controls', () => setOpen(content.hidden), {
    class: 'quiet opener',
    'aria-controls': 'panel',
    'aria-expanded': 'true',
  });
  function setOpen(open: boolean): void {
    content.hidden = !open;
    opener.setAttribute('aria-expanded', String(open));
    region.classList.toggle('closed', !open);
    region.dispatchEvent(new Event('toggle'));
  }
  region.append(element('div', { class: 'panel-bar' }, exit, recentre, opener), content);

  /** A number someone is typing must not change under the fingers. */
  const showNumber = (input: HTMLInputElement, value: number) => {
    if (document.activeElement !== input) input.value = String(Math.round(value));
  };

  return {
    get open() {
      return !content.hidden;
    },
    setOpen,
    show(state) {
      for (const { name, input, about, node } of estimators) {
        const reason = state.unavailable[name];
        input.checked = name === state.estimator;
        input.disabled = reason !== undefined;
        node.classList.toggle('unavailable', reason !== undefined);
        about.textContent = reason ?? estimatorTexts[name].text;
      }
      for (const { view: name, node } of views) node.setAttribute('aria-pressed', String(name === state.view));
      for (const { name, node } of swatches) {
        node.setAttribute('aria-pressed', String(name === state.palette));
        node.disabled = state.palette === null;
      }
      showNumber(height.input, state.heightCm);
      showNumber(armSpan.input, state.armSpanCm);
      eyeHeight.textContent = `Without shoes, fingertip to fingertip. Eyes at ${Math.round(state.eyeHeightCm)} cm, ${state.calibrationSource}.`;
      mirror.input.checked = state.mirror;
      upperBody.input.checked = state.upperBodyOnly;
      skeleton.input.checked = state.debugSkeleton;
      overlay.input.checked = state.overlay;
      largerText.input.checked = state.largerText;
      actor.input.checked = state.actor;
      emulatorPanel.input.checked = state.emulatorPanel;
      emulatorPanel.node.hidden = !state.emulated;
      exit.hidden = !state.inSession;
      loop.input.checked = state.recorder.loop;
      avatarName.textContent = state.avatarName;
      avatarPending.textContent = state.avatarPending;
      avatarPending.hidden = state.avatarPending === null;
      ownAvatar.hidden = !state.ownAvatarOffered;

      const { mode, name, duration } = state.recorder;
      record.disabled = mode === 'recording';
      stop.disabled = mode === 'idle';
      replay.disabled = mode === 'recording' || name === null;
      download.disabled = mode === 'recording' || name === null;
      recorderBar.hidden = mode !== 'replaying';
      recorderBar.value = duration > 0 ? state.recorder.seconds / duration : 0;
      recorderText.textContent =
        mode === 'recording'
          ? `Recording, ${seconds(state.recorder.seconds)}`
          : mode === 'replaying'
            ? `Replaying ${name ?? ''}, ${seconds(state.recorder.seconds)} of ${seconds(duration)}`
            : name
              ? `${name}, ${seconds(duration)}`
              : 'Nothing recorded yet.';
    },
  };
}
