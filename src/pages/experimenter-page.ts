import { reasonOf } from '../core/errors/reasons';
import '../styles/document.css';
import { checkedPlan, type Schedule, type StudyPlan, scheduleFor } from '../core/study/plan';
import type { ParticipantState, Receipt, StudyCommand, StudyListing } from '../core/study/study-api';
import { createExperimenterClient, type ExperimenterClient, ServerRefusal } from '../net/study-client';
import { studyLink } from '../net/study-link';
import { offerDownload } from '../ui/downloads';
import { button, element, pageElement } from '../ui/element';
import { forgetToken, keptToken, signInForm } from './sign-in';
import { studySelect } from './study-select';
import { tableNode } from './table';

/** How often the states are asked for [ms]; a page that has been silent for longer than this is lost [s]. */
const refreshEveryMs = 1500;
const silentAfter = 12;

const content = pageElement('content', HTMLElement);

let client: ExperimenterClient | null = null;
let listed: readonly StudyListing[] = [];
let plan: StudyPlan | null = null;
let retentionUntil = 0;
let simulated = false;
let states: readonly ParticipantState[] = [];
let receipts: readonly Receipt[] = [];
let notice = '';
let complaint = '';
let online = true;
let shownKey = '';
/** A button must not go away between press and release. */
let pressing = false;

async function attempt(action: () => Promise<string | null>): Promise<void> {
  try {
    notice = (await action()) ?? '';
    complaint = '';
  } catch (error) {
    complaint = reasonOf(error);
  }
  await refresh();
}

async function signIn(token: string): Promise<string | null> {
  const candidate = createExperimenterClient(token);
  try {
    listed = await candidate.studies();
  } catch (error) {
    return reasonOf(error);
  }
  client = candidate;
  render();
  return null;
}

async function open(id: string): Promise<void> {
  if (!client || !id) return;
  try {
    const info = await client.records(id);
    plan = info.plan;
    simulated = info.simulated;
    retentionUntil = info.retentionUntil;
    receipts = await client.receipts(id);
    states = await client.participants(id);
    const address = new URL(location.href);
    address.searchParams.set('study', id);
    history.replaceState(null, '', address);
    complaint = '';
  } catch (error) {
    complaint = reasonOf(error);
  }
  render();
}

async function refresh(): Promise<void> {
  if (!client || !plan) {
    render();
    return;
  }
  try {
    states = await client.participants(plan.id);
    receipts = await client.receipts(plan.id);
    online = true;
  } catch (error) {
    online = false;
    if (error instanceof ServerRefusal) complaint = error.message;
  }
  render();
}

/** Asks for a sentence in a dialog; null: cancelled. */
function askFor(title: string, label: string, confirm: string, extra: readonly Node[] = []): Promise<string | null> {
  return new Promise((resolve) => {
    const text = element('textarea', { maxlength: 500, 'aria-label': label });
    const dialog = element('dialog', { 'aria-label': title });
    const close = (value: string | null) => {
      dialog.close();
      dialog.remove();
      resolve(value);
    };
    const go = button(confirm, () => close(text.value.trim()), { class: 'primary', disabled: true });
    text.addEventListener('input', () => {
      go.disabled = text.value.trim() === '';
    });
    dialog.addEventListener('cancel', () => close(null));
    dialog.append(
      element(
        'form',
        { method: 'dialog' },
        element('h2', { style: 'margin:0' }, title),
        element('label', {}, element('span', {}, label), text),
        ...extra,
        element(
          'div',
          { class: 'bar' },
          go,
          button('Cancel', () => close(null)),
        ),
      ),
    );
    document.body.append(dialog);
    dialog.showModal();
  });
}

const clock = (seconds: number) => `${Math.floor(seconds / 60)}:${String(Math.ceil(seconds) % 60).padStart(2, '0')}`;

/** "Archery, block 2 (ik), trial": the experimenter may know the condition. */
function placeText(schedule: Schedule, id: string): string {
  const step = schedule.steps.find((other) => other.id === id);
  if (!step) return id;
  if (!('task' in step)) return step.kind === 'end' ? 'finished' : step.kind;
  const condition = schedule.steps.find(
    (other) => other.kind === 'trial' && other.task === step.task && other.block === step.block,
  );
  const of = condition && 'condition' in condition ? ` (${condition.condition})` : '';
  return `${step.task}, block ${step.block}${of}: ${step.kind}`;
}

function orderTexts(schedule: Schedule, of: StudyPlan): readonly string[] {
  return of.tasks.map(({ id, groupSize }) => {
    const blocks = schedule.steps.flatMap((step) =>
      step.kind === 'trial' && step.task === id && step.repetition === 1 ? [step.condition] : [],
    );
    const group = schedule.groups[id];
    const together =
      groupSize > 1 && group ? ` with ${group.members.filter((name) => name !== schedule.participant).join(', ')}` : '';
    return `${id}: ${blocks.join(' → ')}${together}`;
  });
}

function stateBadge({ session, claimed, withdrawn }: ParticipantState): HTMLElement {
  const badge = (text: string, look = '') => element('span', { class: `badge ${look}` }, text);
  if (withdrawn) return badge('withdrawn');
  if (!session) return badge(claimed ? 'begins' : 'free');
  if (session.kind === 'end') return badge('finished');
  if (Date.now() / 1000 - session.reportedAt > silentAfter) return badge('no contact', 'lost');
  if (session.paused) return badge('paused', 'paused');
  return badge(session.running ? 'running' : 'waiting', 'live');
}

const heardText = (seconds: number) =>
  seconds < 120
    ? `${Math.max(0, Math.round(seconds))} s ago`
    : seconds < 7200
      ? `${Math.round(seconds / 60)} min ago`
      : `${Math.round(seconds / 3600)} h ago`;

function rowOf(state: ParticipantState, of: StudyPlan) {
  const { participant, session, claimed, withdrawn, records } = state;
  const schedule = scheduleFor(of, participant);
  const send = (command: StudyCommand) =>
    attempt(async () => {
      await client?.command(of.id, participant, command);
      return `${participant}: “${command.type}” sent.`;
    });
  const small = (label: string, act: () => void, disabled = false, look = '') =>
    button(label, act, { class: `small ${look}`, disabled });
  const active = session !== null && session.kind !== 'end' && !withdrawn;
  const startable =
    active && !session.paused && !session.running && (session.kind === 'trial' || session.kind === 'tutorial');
  return {
    look: session && Date.now() / 1000 - session.reportedAt > silentAfter ? 'stale' : '',
    cells: [
      participant,
      stateBadge(state),
      session ? placeText(schedule, session.step) : '',
      session?.remainingSeconds != null && session.kind !== 'end' ? clock(session.remainingSeconds) : '',
      session ? heardText(Date.now() / 1000 - session.reportedAt) : '',
      String(records),
      element(
        'div',
        { class: 'row-actions' },
        small('Start', () => void send({ type: 'start' }), !startable),
        session?.paused
          ? small('Go on', () => void send({ type: 'resume' }), !active)
          : small('Pause', () => void send({ type: 'pause' }), !active),
        small('Void block …', () => void voidBlock(of, participant), !active || !session.step.includes('/')),
        small('Remark …', () => void remark(of, participant), records === 0 || withdrawn),
        small('Release', () => void release(of, participant), !claimed),
        small('Export', () => void exportZip(of, participant), records === 0),
        small('Delete …', () => void remove(of, participant), !claimed && records === 0, 'danger'),
      ),
      element('div', { class: 'soft' }, ...orderTexts(schedule, of).map((line) => element('div', {}, line))),
      linkCell(of, state),
    ],
  };
}

/** The participant's page: to open here, to copy, and the invitation to type where a link cannot be sent. */
function linkCell(of: StudyPlan, { participant, invitation }: ParticipantState): HTMLElement | string {
  if (invitation === null) return '';
  const link = studyLink({ study: of.id, participant, invitation });
  return element(
    'div',
    {},
    element(
      'div',
      { class: 'row-actions' },
      element('a', { href: link, target: '_blank', rel: 'noopener' }, 'open'),
      button('Copy', () => void copyLink(participant, link), { class: 'small', title: 'Copy the link' }),
      button('New …', () => void reinvite(of, participant), { class: 'small', title: 'Make a new link' }),
    ),
    element(
      'code',
      { class: 'soft', title: 'The invitation: what the page asks for where it was not in the link' },
      invitation,
    ),
  );
}

async function reinvite(of: StudyPlan, participant: string): Promise<void> {
  const whose = of.entry === 'open' ? 'all participants' : participant;
  if (!confirm(`Make a new link for ${whose}? The old one opens nothing any more; a place that is taken stays taken.`))
    return;
  await attempt(async () => {
    await client?.reinvite(of.id, participant);
    return `${participant} has a new link.`;
  });
}

async function copyLink(participant: string, link: string): Promise<void> {
  const address = new URL(link, location.origin).href;
  await attempt(async () => {
    try {
      await navigator.clipboard.writeText(address);
      return `The link of ${participant} is in the clipboard: give it to ${participant} alone.`;
    } catch {
      // reason: a browser that lets no page write to the clipboard still shows what is to be copied
      return `The link of ${participant}: ${address}`;
    }
  });
}

async function voidBlock(of: StudyPlan, participant: string): Promise<void> {
  const repeat = element('input', { type: 'checkbox', checked: true });
  const text = await askFor(
    `Void the present block of ${participant}`,
    'Why? It is recorded and stated in the results.',
    'Void it',
    [
      element(
        'label',
        { class: 'inline' },
        repeat,
        element('span', {}, 'Repeat the block at once (otherwise the next one follows)'),
      ),
    ],
  );
  if (text === null) return;
  await attempt(async () => {
    await client?.command(of.id, participant, { type: 'void-block', reason: text, repeat: repeat.checked });
    return `${participant}: the block is being voided.`;
  });
}

async function remark(of: StudyPlan, participant: string): Promise<void> {
  const text = await askFor(`Remark on ${participant}`, 'It is stored with the participant’s records.', 'Store');
  if (text === null) return;
  await attempt(async () => {
    await client?.remark(of.id, participant, text);
    return `${participant}: remark stored.`;
  });
}

async function release(of: StudyPlan, participant: string): Promise<void> {
  if (
    !confirm(`Release ${participant}? Another device may then go on; what this one has not sent is lost to the server.`)
  )
    return;
  await attempt(async () => {
    await client?.release(of.id, participant);
    return `${participant} may be taken by another device.`;
  });
}

async function exportZip(of: StudyPlan, participant?: string): Promise<void> {
  await attempt(async () => {
    const file = await client?.export(of.id, participant);
    if (!file) return null;
    offerDownload(file.name, 'application/zip', file.zip);
    return `${file.name} is in your downloads.`;
  });
}

async function remove(of: StudyPlan, participant: string): Promise<void> {
  const typed = await askFor(
    `Delete everything of ${participant}`,
    `This cannot be undone. Type ${participant} to delete its records, movements and commands.`,
    'Delete',
  );
  if (typed === null) return;
  if (typed !== participant) {
    complaint = `Nothing was deleted: "${typed}" is not ${participant}.`;
    render();
    return;
  }
  await attempt(async () => {
    const receipt = await client?.delete(of.id, participant);
    return receipt ? `${participant} is deleted. ${receiptText(receipt)}` : null;
  });
}

const receiptText = ({ number, participant, reason: why, records, motionFiles, at }: Receipt) =>
  `Receipt ${number}: ${participant}, ${why}, ${records} records and ${motionFiles} recordings, ${new Date(at * 1000).toLocaleString()}`;

function newStudy(): HTMLElement {
  const file = element('input', { type: 'file', accept: '.json,application/json', 'aria-label': 'Study file' });
  const isSimulated = element('input', { type: 'checkbox' });
  const begin = (title: string, text: () => Promise<string>) =>
    attempt(async () => {
      const json = await text();
      const checked = checkedPlan(JSON.parse(json));
      const added = isSimulated.checked
        ? { ...checked, id: `${checked.id}-simulated`, title: `SIMULATED: ${checked.title}` }
        : checked;
      await client?.addStudy(added, isSimulated.checked);
      listed = (await client?.studies()) ?? [];
      await open(added.id);
      return `${title} is on this server.`;
    });
  file.addEventListener('change', () => {
    const [chosen] = file.files ?? [];
    if (chosen) void begin(chosen.name, () => chosen.text());
  });
  return element(
    'section',
    { class: 'card' },
    element('h2', { style: 'margin-top:0' }, 'Begin a study'),
    element(
      'div',
      { class: 'bar' },
      button(
        'The paper’s study',
        () => void begin('The paper’s study', async () => (await fetch('/studies/paper.json')).text()),
      ),
      element('label', {}, element('span', {}, 'Or a study file (JSON, docs/study.md)'), file),
      element('label', { class: 'inline' }, isSimulated, element('span', {}, 'simulated: a program takes part')),
    ),
  );
}

function studyParts(): readonly Node[] {
  if (!plan) return [];
  const of = plan;
  return [
    ...(simulated
      ? [
          element(
            'p',
            { class: 'simulated' },
            'SIMULATED: in this study a program takes part. Its data say nothing about people.',
          ),
        ]
      : []),
    element('h2', {}, of.title),
    element(
      'p',
      { class: 'soft' },
      `${of.id} · ${of.participants} participants · consent ${of.consent.version} · deleted after ${new Date(retentionUntil * 1000).toLocaleDateString()}`,
    ),
    element(
      'div',
      { class: 'bar', style: 'margin-top:12px' },
      button('Export all', () => void exportZip(of), { class: 'primary' }),
      element('a', { href: `/results?study=${of.id}` }, 'Results'),
    ),
    tableNode(
      'Participants',
      [
        { text: 'Code' },
        { text: 'State' },
        { text: 'Step' },
        { text: 'Left', numeric: true },
        { text: 'Heard', title: 'When the page last reported', numeric: true },
        { text: 'Records', numeric: true },
        { text: '' },
        { text: 'Order of conditions' },
        { text: 'Page' },
      ],
      states.map((state) => rowOf(state, of)),
    ),
    ...(receipts.length === 0
      ? []
      : [
          element('h2', {}, 'Receipts of deletions'),
          element('ul', {}, ...receipts.map((receipt) => element('li', {}, receiptText(receipt)))),
        ]),
  ];
}

function render(): void {
  if (!client) {
    content.replaceChildren(element('section', { class: 'card' }, signInForm(signIn)));
    return;
  }
  const second = Math.floor(Date.now() / 1000);
  const key = JSON.stringify([listed, plan?.id, states, receipts, notice, complaint, online, second]);
  // An open list, or a field that is being typed in, is not taken away.
  if (key === shownKey || pressing || document.activeElement instanceof HTMLSelectElement) return;
  shownKey = key;
  const focused = document.activeElement?.closest('tr')?.rowIndex;
  const label = document.activeElement?.textContent;
  const select = studySelect(listed, plan?.id, 'No studies yet', (id) => void open(id));
  content.replaceChildren(
    element(
      'section',
      { class: 'card bar' },
      element('label', {}, element('span', {}, 'Study'), select),
      button('Forget the token', () => {
        forgetToken();
        location.reload();
      }),
      element('span', { class: online ? 'badge live' : 'badge lost' }, online ? 'connected' : 'no connection'),
    ),
    element('p', { role: 'status', class: 'soft' }, notice),
    element('p', { role: 'alert', class: 'complaint' }, complaint),
    ...studyParts(),
    ...(plan ? [] : [newStudy()]),
    ...(plan
      ? [
          element(
            'p',
            { style: 'margin-top:24px' },
            element('a', { href: '/experimenter' }, 'Begin or open another study'),
          ),
        ]
      : []),
  );
  if (focused !== undefined && label) {
    const again = [...(content.querySelectorAll('tr')[focused]?.querySelectorAll('button') ?? [])];
    again.find(({ textContent }) => textContent === label)?.focus();
  }
}

async function start(): Promise<void> {
  document.addEventListener('pointerdown', () => {
    pressing = true;
  });
  for (const event of ['pointerup', 'pointercancel']) {
    document.addEventListener(event, () => {
      // The click follows the release.
      setTimeout(() => {
        pressing = false;
      }, 0);
    });
  }
  render();
  const token = keptToken();
  if (token && (await signIn(token)) === null) await open(new URLSearchParams(location.search).get('study') ?? '');
  setInterval(() => {
    if (document.visibilityState === 'visible' && plan) void refresh();
  }, refreshEveryMs);
}

void start();
