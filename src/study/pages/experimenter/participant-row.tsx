import { button, element } from 'threepoint-ui';
import { studyLink } from '../../client/study-link';
import type { StudyPlan } from '../../model/plan/plan';
import { type Schedule, scheduleFor, trialOf } from '../../model/plan/schedule';
import { clockText } from '../../model/progress/progress';
import type { ParticipantState, StudyCommand } from '../../model/progress/study-api';
import type { TableRow } from '../table';

/** A page that was silent for longer than this counts as lost [s]. */
const silentAfter = 12;

/** What an experimenter can do about a participant. */
export interface ParticipantActions {
  command(participant: string, command: StudyCommand): void;
  voidBlock(participant: string): void;
  /** Ends the participant's session. */
  stop(participant: string): void;
  remark(participant: string): void;
  release(participant: string): void;
  exportZip(participant: string): void;
  remove(participant: string): void;
  copyLink(participant: string, link: string): void;
  reinvite(participant: string): void;
}

export const participantHeads = [
  { text: 'Code' },
  { text: 'State' },
  { text: 'Step' },
  { text: 'Time', title: 'The time left of this step', numeric: true },
  { text: 'Seen', title: 'The time since the page last reported', numeric: true },
  { text: 'Records', numeric: true },
  { text: '' },
  { text: 'Order of conditions' },
  { text: 'Page' },
] as const;

/** The plan that a participant follows; `several`: participants follow different versions. */
export interface FollowedPlan {
  readonly plan: StudyPlan;
  readonly several: boolean;
}

/** Returns a participant's row, `age` seconds after the state was received. */
export function participantRow(
  state: ParticipantState,
  { plan, several }: FollowedPlan,
  age: number,
  actions: ParticipantActions,
): TableRow {
  const { participant, session, records } = state;
  const schedule = scheduleFor(plan, participant);
  const silence = session ? session.silence + age : 0;
  return {
    look: silence > silentAfter ? 'stale' : '',
    cells: [
      several ? `${participant}, version ${state.version}` : participant,
      stateBadge(state, silence),
      session ? placeText(schedule, session.step) : '',
      session?.remainingSeconds != null && session.kind !== 'end' ? clockText(session.remainingSeconds) : '',
      session ? lastSeenText(silence) : '',
      String(records),
      actionsCell(state, actions),
      element('div', { class: 'soft' }, ...orderTexts(schedule, plan).map((line) => element('div', {}, line))),
      linkCell(plan.id, state, actions),
    ],
  };
}

const lastSeenText = (seconds: number) =>
  seconds < 120
    ? `${Math.max(0, Math.round(seconds))} s ago`
    : seconds < 7200
      ? `${Math.round(seconds / 60)} min ago`
      : `${Math.round(seconds / 3600)} h ago`;

/** Returns the place as "Archery, block 2 (ik), trial". Experimenters may know the condition. */
function placeText(schedule: Schedule, id: string): string {
  const step = schedule.steps.find((other) => other.id === id);
  if (!step) return id;
  if (!('task' in step)) return step.kind === 'end' ? 'the end' : step.kind;
  const trial = trialOf(schedule, step);
  const of = trial ? ` (${trial.condition})` : '';
  return `${step.task}, block ${step.block}${of}: ${step.kind}`;
}

/** Returns the cohort, if there is one, and the order of conditions in each task. */
function orderTexts(schedule: Schedule, of: StudyPlan): readonly string[] {
  // Makes a name that is not broken between two lines.
  const whole = (id: string) => id.replaceAll('-', '\u2011');
  const orders = of.tasks.map(({ id, groupSize }) => {
    const blocks = schedule.steps.flatMap((step) =>
      step.kind === 'trial' && step.task === id && step.repetition === 1 ? [step.condition] : [],
    );
    const group = schedule.groups[id];
    const together =
      groupSize > 1 && group ? ` with ${group.members.filter((name) => name !== schedule.participant).join(', ')}` : '';
    return `${id}: ${blocks.map(whole).join(' → ')}${together}`;
  });
  return schedule.cohort === null ? orders : [`cohort: ${whole(schedule.cohort)}`, ...orders];
}

function stateBadge({ session, claimed, withdrawn }: ParticipantState, silence: number): HTMLElement {
  const badge = (text: string, look = '') => element('span', { class: `badge ${look}` }, text);
  if (withdrawn) return badge('withdrawn');
  if (!session) return badge(claimed ? 'begins' : 'free');
  if (session.kind === 'end') return badge(session.stopped ? 'stopped' : 'finished', session.stopped ? 'lost' : '');
  if (silence > silentAfter) return badge('no contact', 'lost');
  if (session.unwell) return badge('unwell?', 'lost');
  if (session.paused) return badge('paused', 'paused');
  return badge(session.running ? 'running' : 'waiting', 'live');
}

function actionsCell(
  { participant, session, claimed, withdrawn, records }: ParticipantState,
  actions: ParticipantActions,
): HTMLElement {
  const small = (label: string, act: () => void, disabled: boolean, look = '') =>
    button(label, act, { class: `small ${look}`, disabled });
  const active = session !== null && session.kind !== 'end' && !withdrawn;
  const startable =
    active && !session.paused && !session.running && (session.kind === 'trial' || session.kind === 'tutorial');
  return element(
    'div',
    { class: 'row-actions commands' },
    small('Start', () => actions.command(participant, { type: 'start' }), !startable),
    session?.paused
      ? small('Go on', () => actions.command(participant, { type: 'resume' }), !active)
      : small('Pause', () => actions.command(participant, { type: 'pause' }), !active),
    small('Void block …', () => actions.voidBlock(participant), !active || !session.step.includes('/')),
    small('Stop …', () => actions.stop(participant), !active, 'danger'),
    small('Remark …', () => actions.remark(participant), records === 0 || withdrawn),
    small('Release', () => actions.release(participant), !claimed),
    small('Export', () => actions.exportZip(participant), records === 0),
    small('Delete …', () => actions.remove(participant), !claimed && records === 0, 'danger'),
  );
}

/** Returns the participant's page to open or to copy, and the invitation to type if a link cannot be sent. */
function linkCell(
  study: string,
  { participant, invitation }: ParticipantState,
  actions: ParticipantActions,
): HTMLElement | string {
  if (invitation === null) return '';
  const link = studyLink({ study, participant, invitation });
  return element(
    'div',
    {},
    element(
      'div',
      { class: 'row-actions link' },
      element('a', { href: link, target: '_blank', rel: 'noopener' }, 'open'),
      button('Copy', () => actions.copyLink(participant, link), { class: 'small', title: 'Copy the link' }),
      button('New …', () => actions.reinvite(participant), { class: 'small', title: 'Make a new link' }),
    ),
    element(
      'code',
      { class: 'soft', title: 'The invitation, which the page asks for if the link lacks it' },
      invitation,
    ),
  );
}
