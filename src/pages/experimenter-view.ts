import type { StudyPlan } from '../core/study/plan';
import { remarksOn } from '../core/study/plan-remarks';
import type { ParticipantState, Receipt } from '../core/study/study-api';
import { button, element } from '../ui/element';
import { leavePlan } from '../ui/left-plan';
import { pageFolder } from '../ui/page-folder';
import { type ParticipantActions, participantHeads, participantRow } from './participant-row';
import { tableNode } from './table';

/** A study as the experimenter's page has it open. */
export interface OpenStudy {
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  /** When the server deletes its records by itself [s since 1970]. */
  readonly retentionUntil: number;
  readonly states: readonly ParticipantState[];
  readonly receipts: readonly Receipt[];
}

export interface StudyActions extends ParticipantActions {
  exportAll(): void;
}

export const receiptText = ({ number, participant, reason, records, motionFiles, at }: Receipt) =>
  `Receipt ${number}: ${participant}, ${reason}, ${records} records and ${motionFiles} recordings, ${new Date(at * 1000).toLocaleString()}`;

/** An open study, as of `now` [s since 1970]: what it is, its participants, what was deleted. */
export const openStudy = (study: OpenStudy, now: number, actions: StudyActions): readonly Node[] => [
  ...studyHead(study, actions),
  tableNode(
    'Participants',
    participantHeads,
    study.states.map((state) => participantRow(state, study.plan, now, actions)),
  ),
  ...receiptList(study.receipts),
];

function studyHead({ plan, simulated, retentionUntil }: OpenStudy, actions: StudyActions): readonly Node[] {
  const until = new Date(retentionUntil * 1000).toLocaleDateString();
  const notice = 'SIMULATED: in this study a program takes part. Its data say nothing about people.';
  return [
    ...(simulated ? [element('p', { class: 'simulated' }, notice)] : []),
    element('h2', {}, plan.title),
    element(
      'p',
      { class: 'soft' },
      `${plan.id} · ${plan.participants} participants · consent ${plan.consent.version} · deleted after ${until}`,
    ),
    ...remarkList(remarksOn(plan)),
    element(
      'div',
      { class: 'bar', style: 'margin-top:12px' },
      button('Export all', actions.exportAll, { class: 'primary' }),
      element('a', { href: `./results.html?study=${plan.id}` }, 'Results'),
      previewLink(plan),
    ),
  ];
}

/** To every screen of the plan as participants see it. */
function previewLink(plan: StudyPlan): HTMLElement {
  const link = element('a', { href: './preview.html' }, 'Preview');
  link.addEventListener('click', () => leavePlan(plan));
  return link;
}

/** What to know before the first participant comes. */
const remarkList = (remarks: readonly string[]): readonly Node[] =>
  remarks.length === 0
    ? []
    : [
        element(
          'ul',
          { class: 'remarks', 'aria-label': 'Before you begin' },
          ...remarks.map((text) => element('li', {}, text)),
        ),
      ];

const receiptList = (receipts: readonly Receipt[]): readonly Node[] =>
  receipts.length === 0
    ? []
    : [
        element('h2', {}, 'Receipts of deletions'),
        element('ul', {}, ...receipts.map((receipt) => element('li', {}, receiptText(receipt)))),
      ];

/** A study to be begun: `name` for messages, `json` reads its file. */
export interface NewStudy {
  readonly name: string;
  readonly simulated: boolean;
  json(): Promise<string>;
}

/** Where a study is begun. */
export function newStudyCard(begin: (study: NewStudy) => void): HTMLElement {
  const file = element('input', { type: 'file', accept: '.json,application/json', 'aria-label': 'Study file' });
  const simulated = element('input', { type: 'checkbox' });
  file.addEventListener('change', () => {
    const [chosen] = file.files ?? [];
    if (chosen) begin({ name: chosen.name, simulated: simulated.checked, json: () => chosen.text() });
  });
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
      element('label', {}, element('span', {}, 'Or a study file (JSON, docs/study.md)'), file),
      element('a', { href: './preview.html' }, 'Look at a study file first'),
      element('label', { class: 'inline' }, simulated, element('span', {}, 'simulated: a program takes part')),
    ),
  );
}
