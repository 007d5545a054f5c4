import { type RefObject, render } from 'preact';
import { useRef, useState } from 'preact/hooks';
import {
  type BoneMap,
  type EstimatedJoint,
  type EstimatorName,
  estimatedJoints,
  threePointNames,
} from 'threepoint/core';
import { doubtOfErrors } from 'threepoint/internal';
import type { WorkProgress } from 'threepoint/motion';
import { formatSentence, useEscape } from 'threepoint-ui';
import { Button, type Choice, Chooser, ReplayTimeline, Sentences, StatusLine } from 'threepoint-ui/controls';
import { LazyBonesForm } from '../bones/lazy-bones-form';
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
  /** What was assumed of the file, one sentence each. */
  readonly notes: readonly string[];
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

interface ErrorsProps {
  readonly labels: Labels;
  readonly methods: readonly MethodErrors[];
}

/** The text of a row of the table, of which the first is the mean of all joints. */
function errorText(errors: MethodErrors['mean'] | null, row: number): string {
  if (!(errors instanceof Float64Array)) return none;
  return centimetres(row === 0 ? meanOf(errors) : errors[row - 1]!);
}

/** The errors by joint, of each method now and over the clip. */
const ErrorTable = ({ labels, methods }: ErrorsProps) => (
  <table>
    <thead>
      <tr>
        <td>cm</td>
        {methods.map(({ estimator }) => (
          <th scope="colgroup" colSpan={2}>
            {labels[estimator]}
          </th>
        ))}
      </tr>
      <tr>
        <td />
        {methods.map(() => (
          <>
            <th scope="col">now</th>
            <th scope="col">clip</th>
          </>
        ))}
      </tr>
    </thead>
    <tbody>
      {['Mean', ...estimatedJoints.map((joint) => jointLabels[joint])].map((label, row) => (
        <tr>
          <th scope="row">{label}</th>
          {methods.map(({ now, mean }) => (
            <>
              <td>{errorText(now, row)}</td>
              <td>{errorText(mean, row)}</td>
            </>
          ))}
        </tr>
      ))}
    </tbody>
  </table>
);

/** Lists the methods whose errors over the clip are not measured. */
function Unmeasured({ labels, methods }: ErrorsProps) {
  const unmeasured = methods.filter(({ mean }) => !(mean instanceof Float64Array));
  // One method is measured at a time: it is listed last, before its figures.
  const measured = unmeasured.find(({ mean }) => progressOf(mean)?.fraction);
  const listed = [...unmeasured.filter((method) => method !== measured), ...(measured ? [measured] : [])];
  const words = listed.map(
    ({ estimator, mean }) => `${labels[estimator]}: ${typeof mean === 'string' ? mean : 'measuring …'}`,
  );
  const progress = measured && progressOf(measured.mean);
  return (
    <StatusLine
      class="hint"
      words={words.join(' · ')}
      figures={progress ? `, ${percent(progress)}` : ''}
      hidden={words.length === 0}
    />
  );
}

/** Shows the signs that the file is wrong; those of the errors appear once all methods are measured. */
function Doubts({ methods, doubts }: Pick<CardState, 'methods' | 'doubts'>) {
  const means = methods.map(({ mean }) => mean).filter((mean): mean is JointErrors => mean instanceof Float64Array);
  const ofErrors = means.length < methods.length ? null : doubtOfErrors(means.map(meanOf));
  const sentences = [...doubts, ...(ofErrors === null ? [] : [ofErrors])].map(formatSentence);
  return (
    <p class="complaint" role="status" hidden={sentences.length === 0}>
      {sentences.join(' ')}
    </p>
  );
}

interface OpenedProps {
  /** The button that opens the form for the bones. */
  readonly correct: RefObject<HTMLButtonElement | null>;
  readonly labels: Labels;
  readonly actions: CardActions;
  readonly state: CardState;
}

/** Lets the user choose the clip, the methods and the place of the truth. */
function Choices({ labels, state, actions, correct }: OpenedProps) {
  const [first, second] = state.methods;
  const methods: readonly Choice[] = threePointNames.map((name) => ({ id: name, label: labels[name] }));
  // No file has a device's body. The option is shown if the user selected it before.
  const device = {
    id: 'device',
    label: `${labels.device} (not in the file; ${labels.learned} is used)`,
    disabled: true,
  };
  return (
    <>
      {state.clips.length > 1 && (
        <Chooser
          name="Clip"
          choices={state.clips.map((label, index) => ({ id: String(index), label }))}
          chosen={String(state.clip)}
          choose={(index) => actions.chooseClip(Number(index))}
        />
      )}
      <Chooser
        name="Method"
        choices={[...methods, device]}
        chosen={first?.estimator}
        choose={(name) => actions.choose(name as EstimatorName)}
      />
      <Chooser
        name="Compared with"
        choices={[{ id: '', label: 'nothing' }, ...methods]}
        chosen={second?.estimator}
        choose={(name) => actions.compare(name === '' ? null : (name as EstimatorName))}
      />
      <Chooser
        name="Truth"
        choices={truthPlaces.map((place) => ({ id: place, label: place }))}
        chosen={state.truth}
        choose={(place) => actions.placeTruth(place as TruthPlace)}
      />
      <Button
        label="Copy link"
        disabled={!state.shareable}
        title={
          state.shareable
            ? 'To this second and this method'
            : 'A file on this device has no address that others could open'
        }
        onClick={() => actions.copyLink()}
      />
      <button type="button" ref={correct} hidden={!state.canCorrectBones} onClick={() => actions.correctBones()}>
        Correct the bones…
      </button>
    </>
  );
}

/** Shows the progress of reading a file, and lets the user cancel it. */
const Reading = ({ reading, actions }: Pick<CardProps, 'reading' | 'actions'>) => (
  <div class="reading" hidden={reading === null}>
    <StatusLine
      words={reading ? `Reading ${reading.name}` : ''}
      figures={reading ? `: ${percent(reading.progress)}` : ''}
    />
    <progress max={1} value={reading?.progress.fraction ?? 0} aria-label="Progress of reading" />
    <Button label="Cancel" onClick={() => actions.cancel()} />
  </div>
);

/** Windows in which the open card would cover the body. */
const isSmall = (): boolean => matchMedia('(max-width: 900px), (max-height: 560px)').matches;

/** The opened motion: a line that plays it, and what the line unfolds. */
function Opened({ labels, state, actions, correct }: OpenedProps) {
  const [unfolded, unfold] = useState(() => !isSmall());
  useEscape(unfolded, () => unfold(false));
  return (
    <>
      <div class="line">
        <ReplayTimeline
          name="Time of the clip in seconds"
          paused={state.paused}
          seconds={state.seconds}
          duration={state.duration}
          setPaused={(on) => actions.setPaused(on)}
          seek={(seconds) => actions.seek(seconds)}
        />
        <Button
          label={unfolded ? 'Less' : 'More'}
          class="quiet"
          aria-expanded={unfolded}
          onClick={() => unfold(!unfolded)}
        />
        <Button label="×" aria-label="Close" class="quiet icon" onClick={() => actions.close()} />
      </div>
      {unfolded && (
        <>
          <h2>{state.clips[state.clip]}</h2>
          <ErrorTable labels={labels} methods={state.methods} />
          <Doubts methods={state.methods} doubts={state.doubts} />
          <Unmeasured labels={labels} methods={state.methods} />
          <div class="choices">
            <Choices labels={labels} state={state} actions={actions} correct={correct} />
          </div>
          {state.notes.length > 0 && <Sentences class="hint" sentences={state.notes.map(formatSentence)} />}
        </>
      )}
    </>
  );
}

interface CardProps {
  readonly labels: Labels;
  readonly actions: CardActions;
  /** The progress of reading a file; null: none is being read. */
  readonly reading: { readonly name: string; readonly progress: WorkProgress } | null;
  /** The skeleton of a motion that waits for the user's map; null: none. The form takes the place of the motion. */
  readonly skeleton: SkeletonToMap | null;
  /** null: no clip is open. */
  readonly state: CardState | null;
}

/** The card of an opened motion: errors by joint, timeline, methods and bones. */
function Card({ labels, actions, reading, skeleton, state }: CardProps) {
  const correct = useRef<HTMLButtonElement>(null);
  return (
    <>
      <Reading reading={reading} actions={actions} />
      <LazyBonesForm skeleton={skeleton} opener={correct} apply={actions.applyBones} cancel={actions.cancelBones} />
      {state && (
        <div class="opened" hidden={skeleton !== null}>
          <Opened labels={labels} state={state} actions={actions} correct={correct} />
        </div>
      )}
    </>
  );
}

/** Creates the card, which is hidden while it has nothing to show. */
export function createMocapCard(labels: Labels, actions: CardActions) {
  const node = document.createElement('section');
  node.className = 'mocap';
  node.ariaLabel = 'Motion capture';
  node.hidden = true;
  let shown: Pick<CardProps, 'reading' | 'skeleton' | 'state'> = { reading: null, skeleton: null, state: null };
  let isVisible = true;
  return {
    node,
    /** Updates these parts of the card. `visible`: the place that the card belongs to is shown. */
    show({ visible = isVisible, ...part }: Partial<typeof shown> & { readonly visible?: boolean }): void {
      shown = { ...shown, ...part };
      isVisible = visible;
      node.hidden = !visible || Object.values(shown).every((value) => value === null);
      render(visible && <Card labels={labels} actions={actions} {...shown} />, node);
    },
  };
}

export type MocapCard = ReturnType<typeof createMocapCard>;
