import { reasonOf } from 'threepoint/core/errors/reasons';
import { studyTitle } from '../model/plan/plan';
import 'threepoint-ui/styles/document.css';
import { button, element, pageElement } from 'threepoint-ui/element';
import { paperCheck } from './paper-check';
import { firstSelection, type Selection, simulatedNotice, studyResults } from './results-view';
import type { ShownStudy } from './shown-results';
import { StudyAccess } from './study-access';
import { openStudyFile } from './study-file';

const content = pageElement('content', HTMLElement);

const access = new StudyAccess(
  () => render(),
  (study) => void load(study),
);
let shown: (ShownStudy & { readonly source: string }) | null = null;
let selection: Selection | null = null;
let complaint = '';

function showStudy(study: ShownStudy, source: string): void {
  shown = { ...study, source };
  selection = firstSelection(study.plan);
  complaint = '';
  render();
}

async function load(id: string, version?: number): Promise<void> {
  if (!access.client || !id) return;
  try {
    const { plan, simulated, records, version: shownVersion, versions } = await access.open(access.client, id, version);
    const several = versions.length > 1 ? { planVersion: shownVersion, versions } : {};
    showStudy({ plan, simulated, records, ...several }, 'this server');
  } catch (error) {
    complaint = reasonOf(error);
    render();
  }
}

async function openFile(file: File): Promise<void> {
  try {
    showStudy(openStudyFile(new Uint8Array(await file.arrayBuffer())), file.name);
  } catch (error) {
    complaint = `${file.name}: ${reasonOf(error)}`;
    render();
  }
}

function sourceBar(): HTMLElement {
  const file = element('input', { type: 'file', accept: '.zip,application/zip', 'aria-label': 'Export of a study' });
  file.addEventListener('change', () => {
    const [chosen] = file.files ?? [];
    if (chosen) void openFile(chosen);
  });
  const fileField = element('label', {}, element('span', {}, 'Or an export (zip), from this computer'), file);
  if (!access.client)
    return element('section', { class: 'card' }, access.form(), element('div', { class: 'bar' }, fileField));
  return element(
    'section',
    { class: 'card bar' },
    access.select(shown?.plan.id, 'This server has no studies yet', (id) => void load(id)),
    ...(shown ? [button('Refresh', () => void load(shown?.plan.id ?? '', shown?.planVersion))] : []),
    fileField,
    access.forgetButton(),
  );
}

/** Of a plan that was changed: which version is shown, and who is in the others. */
function versionBar({ plan, planVersion, versions = [] }: ShownStudy): readonly Node[] {
  // An export holds one version, and nothing of the others.
  if (planVersion === undefined || versions.length === 0) return [];
  const select = element(
    'select',
    { 'aria-label': 'Version of the plan' },
    ...versions.map(({ version, participants }) =>
      element(
        'option',
        { value: version, selected: version === planVersion },
        `Version ${version}: ${participants.length} participants`,
      ),
    ),
  );
  select.addEventListener('change', () => void load(plan.id, Number(select.value)));
  return [
    element(
      'div',
      { class: 'bar' },
      element('label', {}, element('span', {}, 'Version of the plan'), select),
      element(
        'p',
        { class: 'soft' },
        'The plan was changed while the study ran. What is below is of one version alone.',
      ),
    ),
  ];
}

function results(): readonly Node[] {
  if (!shown || !selection) return [];
  const { plan, planVersion, source } = shown;
  const heading = element('h2', {}, studyTitle(plan));
  const where = element(
    'p',
    { class: 'soft' },
    `${plan.id}${planVersion === undefined ? '' : `, version ${planVersion} of its plan`}, from ${source}.`,
  );
  const choose = (chosen: Selection) => {
    selection = chosen;
    render();
  };
  try {
    const computed = studyResults(shown, selection, choose);
    return [heading, where, ...versionBar(shown), ...simulatedNotice(shown), ...computed];
  } catch (error) {
    return [heading, where, element('p', { class: 'complaint', role: 'alert' }, reasonOf(error))];
  }
}

function render(): void {
  content.replaceChildren(
    sourceBar(),
    ...(complaint ? [element('p', { class: 'complaint', role: 'alert' }, complaint)] : []),
    ...results(),
    ...paperCheck(),
  );
}

render();
void access.resume();
