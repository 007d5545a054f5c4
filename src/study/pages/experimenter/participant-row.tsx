import { Button } from 'threepoint-ui/controls';
import { studyLink } from '../../client/study-link';
import { type Schedule, scheduleFor, trialOf } from '../../model/plan/schedule';
import { clockText } from '../../model/progress/progress';
import type { ParticipantState } from '../../model/progress/study-api';
import { type Column, numberColumn, textColumn } from '../table';
import { type OpenStudy, planOf } from './experimenter-state';
import {
  copyLink,
  download,
  reinvite,
  release,
  remark,
  remove,
  sendCommand,
  stop,
  voidBlock,
} from './participant-actions';
import { timeLeft } from './time-left';

/** A page that was silent for longer than this counts as lost [s]. */
const silentAfter = 12;

/** Returns what the table shows of participants, `age` seconds after their states were received. */
export const shownParticipants = (study: OpenStudy, age: number) =>
  study.states.map((state) => {
    const plan = planOf(study, state.version);
    const silence = state.session ? state.session.silence + age : 0;
    const schedule = scheduleFor(plan, state.participant);
    return { state, plan, schedule, silence, remaining: timeLeft(study.states, schedule, state) };
  });

type ShownParticipant = ReturnType<typeof shownParticipants>[number];

export const participantLook = ({ silence }: ShownParticipant) => (silence > silentAfter ? 'stale' : '');

/** Returns the columns; `several`: participants follow different versions of the plan. */
export const participantColumns = (several: boolean): readonly Column<ShownParticipant>[] => [
  textColumn('Code', ({ state }) => (several ? `${state.participant}, version ${state.version}` : state.participant)),
  textColumn('State', (shown) => <StateBadge {...shown} />),
  textColumn('Step', ({ state, schedule }) => state.session && placeText(schedule, state.session.step)),
  numberColumn(
    'Time',
    ({ state, remaining }) => remaining !== null && state.session?.kind !== 'end' && clockText(remaining),
    'The time left of this step, or of the match of a group',
  ),
  numberColumn(
    'Seen',
    ({ state, silence }) => state.session && lastSeenText(silence),
    'The time since the page last reported',
  ),
  numberColumn('Records', ({ state }) => state.records),
  textColumn('Actions', ({ state }) => <Commands {...state} />),
  textColumn('Order of conditions', (shown) => <Order {...shown} />),
  textColumn('Page', ({ state, plan }) => <PageLink {...state} study={plan.id} />),
];

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

/** The cohort, if there is one, and the order of conditions in each task. */
function Order({ schedule, plan }: ShownParticipant) {
  // Makes a name that is not broken between two lines.
  const whole = (id: string) => id.replaceAll('-', '\u2011');
  const orders = plan.tasks.map(({ id, groupSize }) => {
    const blocks = schedule.steps.flatMap((step) =>
      step.kind === 'trial' && step.task === id && step.repetition === 1 ? [step.condition] : [],
    );
    const group = schedule.groups[id];
    const together =
      groupSize > 1 && group ? ` with ${group.members.filter((name) => name !== schedule.participant).join(', ')}` : '';
    return `${id}: ${blocks.map(whole).join(' → ')}${together}`;
  });
  return (
    <div class="soft">
      {schedule.cohort !== null && <div>{`cohort: ${whole(schedule.cohort)}`}</div>}
      {orders.map((order) => (
        <div>{order}</div>
      ))}
    </div>
  );
}

function StateBadge({ state, silence }: ShownParticipant) {
  const [text, look = ''] = badgeOf(state, silence);
  return <span class={`badge ${look}`}>{text}</span>;
}

/** Returns the text of a participant's state, and its class. */
function badgeOf({ session, claimed, withdrawn }: ParticipantState, silence: number): readonly [string, string?] {
  if (withdrawn) return ['withdrawn'];
  if (!session) return [claimed ? 'begins' : 'free'];
  if (session.kind === 'end') return session.stopped ? ['stopped', 'lost'] : ['finished'];
  if (silence > silentAfter) return ['no contact', 'lost'];
  if (session.unwell) return ['unwell?', 'lost'];
  if (session.paused) return ['paused', 'paused'];
  return [session.running && !session.waiting ? 'running' : 'waiting', 'live'];
}

function Commands({ participant, session, claimed, withdrawn, records }: ParticipantState) {
  if (!claimed && records === 0)
    return <div class="row-actions commands soft">{!withdrawn && 'Nobody has opened the page.'}</div>;
  const small = (label: string, act: () => Promise<void>, disabled: boolean, look = '') => (
    <Button label={label} class={`small ${look}`} disabled={disabled} onClick={act} />
  );
  const active = session !== null && session.kind !== 'end';
  const startable =
    active && !session.paused && !session.running && (session.kind === 'trial' || session.kind === 'tutorial');
  return (
    <div class="row-actions commands">
      {small('Start', () => sendCommand(participant, { type: 'start' }), !startable)}
      {session?.paused
        ? small('Go on', () => sendCommand(participant, { type: 'resume' }), !active)
        : small('Pause', () => sendCommand(participant, { type: 'pause' }), !active)}
      {small('Void block …', () => voidBlock(participant), !active || !session.step.includes('/'))}
      {small('Stop …', () => stop(participant), !active, 'danger')}
      {small('Remark …', () => remark(participant), records === 0)}
      {small('Release', () => release(participant), !claimed)}
      {small('Export', () => download({ participant }), records === 0)}
      {small('Delete …', () => remove(participant), false, 'danger')}
    </div>
  );
}

/** The participant's page to open or to copy, and the invitation to type if a link cannot be sent. */
function PageLink({ study, participant, invitation }: ParticipantState & { readonly study: string }) {
  if (invitation === null) return null;
  const link = studyLink({ study, participant, invitation });
  return (
    <div>
      <div class="row-actions link">
        <a href={link} target="_blank" rel="noopener">
          open
        </a>
        <Button label="Copy" class="small" title="Copy the link" onClick={() => copyLink(participant, link)} />
        <Button label="New …" class="small" title="Make a new link" onClick={() => reinvite(participant)} />
      </div>
      <code class="soft" title="The invitation, which the page asks for if the link lacks it">
        {invitation}
      </code>
    </div>
  );
}
