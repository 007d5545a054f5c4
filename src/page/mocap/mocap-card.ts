import {
  type BoneMap,
  type EstimatedJoint,
  type EstimatorName,
  estimatedJoints,
  threePointNames,
} from 'threepoint/core';
import { doubtOfErrors, type WorkProgress } from 'threepoint/motion';
import { button, createStatusLine, element, labelled } from 'threepoint-ui';
import { createLazyBonesForm } from '../bones/lazy-bones-form';
import type { SkeletonToMap } from '../bones/skeleton-to-map';
import type { ClipMean } from './clip-means';
import { type JointErrors, meanOf } from './joint-errors';
import { type TruthPlace, truthPlaces } from './truth-places';
import './mocap.css';

interface MethodErrors {
  readonly estimator: EstimatorName;
  /** The errors of the current frame; null: no body is drawn. */
  readonly now: JointErrors | null;
  /** The mean errors of the whole clip. */
  readonly mean: ClipMean;
}

/** The state of an opened clip that the card shows. */
interface CardState {
  readonly clips: readonly string[];
  readonly clip: number;
  readonly paused: boolean;
  readonly seconds: number;
  readonly duration: number;
  readonly truth: TruthPlace;
  /** Whether the files have addresses that others can open. */
  readonly shareable: boolean;
  /** Whether the user can correct the bones: no JSON map names them. */
  readonly canCorrectBones: boolean;
  /** Signs that the file is wrong, one sentence each. */
  readonly doubts: readonly string[];
  /** The errors of the body, and of the second body if there is one. */
  readonly methods: readonly MethodErrors[];
}

export interface CardActions {
  chooseClip(index: number): void;
  setPaused(on: boolean): void;
  seek(seconds: number): void;
  choose(estimator: EstimatorName): void;
  compare(estimator: EstimatorName | null): void;
  placeTruth(place: TruthPlace): void;
  copyLink(): void;
  /** Opens the form for the bones of the motion. */
  correctBones(): void;
  /** Reads the motion with these bones; null: forgets the user's map. */
  applyBones(bones: BoneMap | null): void;
  cancelBones(): void;
  cancel(): void;
  close(): void;
}

export type Labels = Readonly<Record<EstimatorName, string>>;

const jointLabels: Readonly<Record<EstimatedJoint, string>> = {
  leftLowerArm: 'Left elbow',
  rightLowerArm: 'Right elbow',
  leftUpperArm: 'Left shoulder',
  rightUpperArm: 'Right shoulder',
  chest: 'Chest',
  hips: 'Pelvis',
};
const none = '–';
const centimetres = (value: number): string => value.toFixed(1);
const percent = ({ fraction, secondsLeft }: WorkProgress): string =>
  `${Math.floor(100 * fraction)}\u00a0%${secondsLeft === null ? '' : `, ${Math.ceil(secondsLeft)} s left`}`;

/** Returns the progress of measuring; null: it has ended or failed. */
const progressOf = (mean: ClipMean): WorkProgress | null =>
  typeof mean === 'string' || mean instanceof Float64Array ? null : mean;

/** Creates a labelled select element. */
function choice<Value extends string>(
  label: string,
  options: readonly (readonly [Value, string])[],
  onChoose: (value: Value) => void,
) {
  const select = element(
    'select',
    { 'aria-label': label },
    ...options.map(([value, text]) => element('option', { value }, text)),
  );
  select.addEventListener('change', () => onChoose(select.value as Value));
  return { select, node: labelled(label, select) };
}

function createErrorTable(labels: Labels) {
  const head = element('tr');
  const under = element('tr');
  const rows = ['Mean', ...estimatedJoints.map((joint) => jointLabels[joint])].map((label) =>
    element('tr', {}, element('th', { scope: 'row' }, label)),
  );
  const line = createStatusLine({ class: 'hint' });
  const doubt = element('p', { class: 'complaint', role: 'status', hidden: true });
  const cell = (errors: MethodErrors['mean'] | null, row: number): string => {
    if (!(errors instanceof Float64Array)) return none;
    return centimetres(row === 0 ? meanOf(errors) : errors[row - 1]!);
  };
  let shown = '';
  return {
    nodes: [element('table', {}, element('thead', {}, head, under), element('tbody', {}, ...rows)), doubt, line.node],
    show(methods: readonly MethodErrors[], doubts: readonly string[]) {
      const names = methods.map(({ estimator }) => labels[estimator]);
      if (shown !== names.join()) {
        shown = names.join();
        head.replaceChildren(
          element('td', {}, 'cm'),
          ...names.map((name) => element('th', { scope: 'colgroup', colspan: 2 }, name)),
        );
        under.replaceChildren(
          element('td'),
          ...names.flatMap(() => ['now', 'clip'].map((text) => element('th', { scope: 'col' }, text))),
        );
        for (const row of rows)
          row.replaceChildren(row.firstChild!, ...names.flatMap(() => [element('td'), element('td')]));
      }
      for (const [i, row] of rows.entries()) {
        const cells = [...row.querySelectorAll('td')];
        for (const [k, { now, mean }] of methods.entries()) {
          cells[2 * k]!.textContent = cell(now, i);
          cells[2 * k + 1]!.textContent = cell(mean, i);
        }
      }
      const unmeasured = methods.filter(({ mean }) => !(mean instanceof Float64Array));
      // One method is measured at a time: it is listed last, before its figures.
      const measured = unmeasured.find(({ mean }) => progressOf(mean)?.fraction);
      const listed = [...unmeasured.filter((method) => method !== measured), ...(measured ? [measured] : [])];
      const words = listed.map(
        ({ estimator, mean }) => `${labels[estimator]}: ${typeof mean === 'string' ? mean : 'measuring …'}`,
      );
      const progress = measured && progressOf(measured.mean);
      line.show(words.join(' · '), progress ? `, ${percent(progress)}` : '');
      line.node.hidden = words.length === 0;
      const ofErrors =
        unmeasured.length > 0 ? null : doubtOfErrors(methods.map(({ mean }) => meanOf(mean as JointErrors)));
      const sentences = [...doubts, ...(ofErrors === null ? [] : [ofErrors])].map(
        (sentence) => `${sentence[0]!.toUpperCase()}${sentence.slice(1)}.`,
      );
      doubt.hidden = sentences.length === 0;
      if (doubt.textContent !== sentences.join(' ')) doubt.textContent = sentences.join(' ');
    },
  };
}

/** Shows the position in the clip, and lets the user seek. */
function createTimeline(actions: CardActions) {
  const play = button('Pause', () => actions.setPaused(play.getAttribute('aria-pressed') !== 'true'), {
    'aria-pressed': 'false',
  });
  const slider = element('input', {
    type: 'range',
    min: 0,
    max: 1,
    step: 0.01,
    value: 0,
    'aria-label': 'Time of the clip in seconds',
  });
  slider.addEventListener('input', () => actions.seek(slider.valueAsNumber));
  const text = element('span', { class: 'time' });
  return {
    node: element('div', { class: 'timeline' }, play, slider, text),
    show({ paused, seconds, duration }: CardState) {
      play.setAttribute('aria-pressed', String(paused));
      play.textContent = paused ? 'Play' : 'Pause';
      slider.max = String(duration);
      slider.value = String(seconds);
      text.textContent = `${seconds.toFixed(1)} / ${duration.toFixed(1)} s`;
    },
  };
}

/** Lists the clips of a file unless they are listed already: rebuilding an open select element closes it. */
function listClips(select: HTMLSelectElement, names: readonly string[]): void {
  const listed = Array.from(select.options, ({ text }) => text);
  if (listed.join('\n') === names.join('\n')) return;
  select.replaceChildren(...names.map((name, i) => element('option', { value: i }, name)));
}

/** Shows the progress of reading a file, and lets the user cancel it. */
function createReading(actions: CardActions) {
  const line = createStatusLine();
  const bar = element('progress', { max: 1, value: 0, 'aria-label': 'Progress of reading' });
  const node = element(
    'div',
    { class: 'reading', hidden: true },
    line.node,
    bar,
    button('Cancel', () => actions.cancel()),
  );
  return {
    node,
    show(name: string, progress: WorkProgress | null): void {
      node.hidden = progress === null;
      if (progress) line.show(`Reading ${name}`, `: ${percent(progress)}`);
      else line.show('');
      bar.value = progress?.fraction ?? 0;
    },
  };
}

/** Lets the user choose the clip, the methods and the place of the truth, and correct the bones. */
function createChoices(labels: Labels, actions: CardActions) {
  const methods = threePointNames.map((name) => [name, labels[name]] as const);
  const clip = choice<string>('Clip', [], (index) => actions.chooseClip(Number(index)));
  const method = choice<EstimatorName>(
    'Method',
    [...methods, ['device', `${labels.device} (not in the file: ${labels.learned} draws)`]],
    actions.choose,
  );
  // No file has a device's body. The option is shown if the user selected it before.
  method.select.options[methods.length]!.disabled = true;
  const beside = choice<EstimatorName | 'none'>('On its right', [['none', 'nothing'], ...methods], (name) =>
    actions.compare(name === 'none' ? null : name),
  );
  const truth = choice(
    'Truth',
    truthPlaces.map((place) => [place, place] as const),
    actions.placeTruth,
  );
  const link = button('Copy link', () => actions.copyLink());
  const correct = button('Correct the bones…', () => actions.correctBones());
  return {
    node: element('div', { class: 'choices' }, clip.node, method.node, beside.node, truth.node, link, correct),
    correct,
    show(state: CardState): void {
      clip.node.hidden = state.clips.length === 1;
      listClips(clip.select, state.clips);
      clip.select.value = String(state.clip);
      const [first, second] = state.methods;
      method.select.value = first!.estimator;
      beside.select.value = second?.estimator ?? 'none';
      truth.select.value = state.truth;
      link.disabled = !state.shareable;
      link.title = state.shareable
        ? 'To this second and this method'
        : 'A file on this device has no address that others could open';
      correct.hidden = !state.canCorrectBones;
    },
  };
}

/** Creates the card of an opened motion: errors by joint, timeline, methods and bones. */
export function createMocapCard(labels: Labels, actions: CardActions) {
  const title = element('h2');
  const close = button('Close', () => actions.close(), { class: 'quiet' });
  const table = createErrorTable(labels);
  const timeline = createTimeline(actions);
  const choices = createChoices(labels, actions);
  const reading = createReading(actions);
  const bones = createLazyBonesForm({ apply: actions.applyBones, cancel: actions.cancelBones });
  const opened = element(
    'div',
    { class: 'opened' },
    element('div', { class: 'title' }, title, close),
    timeline.node,
    ...table.nodes,
    choices.node,
  );
  const parts = [reading.node, bones.node, opened];
  const node = element('section', { class: 'mocap', 'aria-label': 'Motion capture', hidden: true }, ...parts);
  let isOpen = false;
  bones.node.hidden = true;
  /** The form for the bones takes the place of the motion. */
  const layOut = (): void => {
    opened.hidden = !isOpen || !bones.node.hidden;
    node.hidden = parts.every(({ hidden }) => hidden);
  };
  return {
    node,
    /** Shows the progress of reading a file; null: none is being read. */
    showProgress(name: string, progress: WorkProgress | null): void {
      reading.show(name, progress);
      layOut();
    },
    /** Shows the form for the bones of a motion; null: none waits for them. */
    showBones(skeleton: SkeletonToMap | null): void {
      const hadFocus = bones.node.contains(document.activeElement);
      bones.node.hidden = skeleton === null;
      layOut();
      bones.show(skeleton);
      if (hadFocus && !skeleton && isOpen) choices.correct.focus();
    },
    show(state: CardState | null): void {
      isOpen = state !== null;
      layOut();
      if (!state) return;
      title.textContent = state.clips[state.clip]!;
      choices.show(state);
      table.show(state.methods, state.doubts);
      timeline.show(state);
    },
  };
}

export type MocapCard = ReturnType<typeof createMocapCard>;
