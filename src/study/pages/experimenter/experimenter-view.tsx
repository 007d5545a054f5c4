import { button, element, fileField, pageFolder, storePreviewPlan } from 'threepoint-ui';
import { type StudyPlan, studyTitle } from '../../model/plan/plan';
import { remarksOn } from '../../model/plan/plan-remarks';
import type { ParticipantState, Receipt, StudyInfo } from '../../model/progress/study-api';
import { tableNode } from '../table';
import { type ParticipantActions, participantHeads, participantRow } from './participant-row';

/** A study that is open on the experimenter's page. */
export interface OpenStudy extends StudyInfo {
  readonly states: readonly ParticipantState[];
  /** The time at which the states were received, by the clock of this page [s since 1970]. */
  readonly receivedAt: number;
  readonly receipts: readonly Receipt[];
}

export interface StudyActions extends ParticipantActions {
  /** Stores simulated participants of the plan in a separate study. */
  simulate(): void;
  /** Deletes a simulated study completely. */
  deleteSimulated(): void;
  /** Exports the records under this version of the plan. */
  exportAll(version: number): void;
}

export const receiptText = ({ number, participant, reason, records, motionFiles, at }: Receipt) =>
  `Receipt ${number}: ${participant}, ${reason}, ${records} records and ${motionFiles} recordings, ${new Date(at * 1000).toLocaleString()}`;

/** Returns a sentence about the versions of the plan, or an empty text if there is only one. */
export function versionsText({ versions }: Pick<OpenStudy, 'versions'>): string {
  const newest = versions.at(-1);
  if (!newest || versions.length < 2) return '';
  const stays = versions
    .slice(0, -1)
    .filter(({ participants }) => participants.length > 0)
    .map(({ version, participants }) => `with version ${version}: ${participants.join(', ')}`);
  return (
    `The plan was changed: version ${newest.version} is for those who begin now. ` +
    `Earlier participants stay ${stays.join('; ')}. Results and exports keep the versions apart.`
  );
}

/** Returns the plan of the version that a participant follows, or the newest plan. */
export const planOf = ({ plan, versions }: Pick<OpenStudy, 'plan' | 'versions'>, followed: number | undefined) =>
  versions.find(({ version }) => version === followed)?.plan ?? plan;

/**
 * Returns the parts of an open study at `now` [s since 1970, by the clock of this page]: heading, participants,
 * receipts.
 */
export const openStudy = (study: OpenStudy, now: number, actions: StudyActions): readonly Node[] => [
  ...studyHead(study, actions),
  tableNode(
    'Participants',
    participantHeads,
    study.states.map((state) => {
      const several = study.versions.length > 1;
      return participantRow(
        state,
        { plan: planOf(study, state.version), several },
        Math.max(0, now - study.receivedAt),
        actions,
      );
    }),
  ),
  ...receiptList(study.receipts),
];

function studyHead(study: OpenStudy, actions: StudyActions): readonly Node[] {
  const { plan, simulated, retentionUntil, versions } = study;
  const until = new Date(retentionUntil * 1000).toLocaleDateString();
  const notice = 'SIMULATED: a program takes part in this study. Its data say nothing about people.';
  return [
    ...(simulated ? [element('p', { class: 'simulated' }, notice)] : []),
    element('h2', {}, studyTitle(plan)),
    element(
      'p',
      { class: 'soft' },
      `${plan.id} · ${plan.participants} participants · consent ${plan.consent.version} · deleted after ${until}`,
    ),
    ...(versions.length > 1 ? [element('p', {}, versionsText(study))] : []),
    ...remarkList(remarksOn(plan)),
    element(
      'div',
      { class: 'bar', style: 'margin-top:12px' },
      ...versions.toReversed().map(({ version }, index) =>
        button(versions.length > 1 ? `Export version ${version}` : 'Export all', () => actions.exportAll(version), {
          class: index === 0 ? 'primary' : undefined,
        }),
      ),
      element('a', { href: `./results.html?study=${plan.id}` }, 'Results'),
      previewLink(plan),
      simulated
        ? button('Delete this simulated study …', actions.deleteSimulated, { class: 'danger' })
        : button('Simulate …', actions.simulate),
    ),
  ];
}

/** Returns the link to a preview of every screen of the plan. */
function previewLink(plan: StudyPlan): HTMLElement {
  const link = element('a', { href: './preview.html' }, 'Preview');
  link.addEventListener('click', () => storePreviewPlan(plan));
  return link;
}

/** Returns the remarks to read before the first participant comes. */
const remarkList = (remarks: readonly string[]): readonly Node[] =>
  remarks.length === 0
    ? []
    : [
        element(
          'section',
          { class: 'remarks' },
          element('h3', { id: 'before-you-begin' }, 'Before you begin'),
          element('ul', { 'aria-labelledby': 'before-you-begin' }, ...remarks.map((text) => element('li', {}, text))),
        ),
      ];

const receiptList = (receipts: readonly Receipt[]): readonly Node[] =>
  receipts.length === 0
    ? []
    : [
        element('h2', {}, 'Receipts of deletions'),
        element('ul', {}, ...receipts.map((receipt) => element('li', {}, receiptText(receipt)))),
      ];

/** A new study: `name` is for messages, `json` reads its file. */
export interface NewStudy {
  readonly name: string;
  readonly simulated: boolean;
  json(): Promise<string>;
}

export interface NewStudyActions {
  begin(study: NewStudy): void;
  /** Called when the mark changes, because the card is rebuilt after an invalid file. */
  mark(simulated: boolean): void;
}

/** Returns the card on which a study is started; `marked`: it is marked as simulated. */
export function newStudyCard(marked: boolean, { begin, mark }: NewStudyActions): HTMLElement {
  const simulated = element('input', { type: 'checkbox', checked: marked });
  simulated.addEventListener('change', () => mark(simulated.checked));
  const open = (file: File) => begin({ name: file.name, simulated: simulated.checked, json: () => file.text() });
  const paper = async () => (await fetch(`${pageFolder()}/studies/paper.json`)).text();
  return element(
    'section',
    { class: 'card' },
    element('h2', { style: 'margin-top:0' }, 'Begin a study'),
    element(
      'div',
      { class: 'bar' },
      button('The paper’s study', () =>
        begin({ name: 'The paper’s study', simulated: simulated.checked, json: paper }),
      ),
      fileField('Or a study file (JSON, docs/study.md)', 'Study file', '.json,application/json', open),
      element('a', { href: './preview.html' }, 'Preview a study file first'),
      element('label', { class: 'inline' }, simulated, element('span', {}, 'simulated: a program takes part')),
    ),
  );
}
