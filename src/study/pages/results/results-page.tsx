import { reasonOf } from 'threepoint/core';
import { studyTitle } from '../../model/plan/plan';
import 'threepoint-ui/styles/document.css';
import { button, chooser, element, fileField, pageElement } from 'threepoint-ui';
import { ExperimenterAccess } from '../experimenter-access';
import { openStudyFile } from '../study-file';
import { paperCheck } from './paper-check';
import { firstSelection, type Selection, simulatedNotice, studyResults } from './results-view';
import type { ShownStudy } from './shown-results';

/** The page of results: a study of this server or of an export, and what it shows about it. */
class ResultsPage {
  readonly #content: HTMLElement;
  readonly #access = new ExperimenterAccess(
    () => this.#render(),
    (study) => void this.#load(study),
  );
  #shown: (ShownStudy & { readonly source: string }) | null = null;
  #selection: Selection | null = null;
  #complaint = '';

  constructor(content: HTMLElement) {
    this.#content = content;
  }

  start(): void {
    this.#render();
    void this.#access.resume();
  }

  #show(study: ShownStudy, source: string): void {
    this.#shown = { ...study, source };
    this.#selection = firstSelection(study.plan);
    this.#complaint = '';
    this.#render();
  }

  #complain(complaint: string): void {
    this.#complaint = complaint;
    this.#render();
  }

  async #load(id: string, planVersion?: number): Promise<void> {
    const { client } = this.#access;
    if (!client || !id) return;
    try {
      const { plan, simulated, records, version, versions } = await this.#access.open(client, id, planVersion);
      const several = versions.length > 1 ? { planVersion: version, versions } : {};
      this.#show({ plan, simulated, records, ...several }, 'this server');
    } catch (error) {
      this.#complain(reasonOf(error));
    }
  }

  async #openFile(file: File): Promise<void> {
    try {
      this.#show(openStudyFile(new Uint8Array(await file.arrayBuffer())), file.name);
    } catch (error) {
      this.#complain(`${file.name}: ${reasonOf(error)}`);
    }
  }

  #sourceBar(): HTMLElement {
    const access = this.#access;
    const shown = this.#shown;
    const label = 'Or an export (zip), from this computer';
    const open = (file: File) => void this.#openFile(file);
    const file = fileField(label, 'Export of a study', '.zip,application/zip', open);
    if (!access.client) {
      return element('section', { class: 'card' }, access.form(), element('div', { class: 'bar' }, file));
    }
    return element(
      'section',
      { class: 'card bar' },
      access.select(shown?.plan.id, 'This server has no studies yet', (id) => void this.#load(id)),
      ...(shown ? [button('Refresh', () => void this.#load(shown.plan.id, shown.planVersion))] : []),
      file,
      access.signOutButton(),
    );
  }

  #results(): readonly Node[] {
    const shown = this.#shown;
    if (!shown || !this.#selection) return [];
    const { plan, planVersion, source } = shown;
    const heading = element('h2', {}, studyTitle(plan));
    const where = element(
      'p',
      { class: 'soft' },
      `${plan.id}${planVersion === undefined ? '' : `, version ${planVersion} of its plan`}, from ${source}.`,
    );
    const choose = (chosen: Selection) => {
      this.#selection = chosen;
      this.#render();
    };
    try {
      const computed = studyResults(shown, this.#selection, choose);
      const versions = versionBar(shown, (version) => void this.#load(plan.id, version));
      return [heading, where, ...versions, ...simulatedNotice(shown), ...computed];
    } catch (error) {
      return [heading, where, element('p', { class: 'complaint', role: 'alert' }, reasonOf(error))];
    }
  }

  #render(): void {
    this.#content.replaceChildren(
      this.#sourceBar(),
      ...(this.#complaint ? [element('p', { class: 'complaint', role: 'alert' }, this.#complaint)] : []),
      ...this.#results(),
      ...paperCheck(),
    );
  }
}

/** Returns the choice of a version for a plan that was changed; nothing for others. */
function versionBar({ planVersion, versions = [] }: ShownStudy, choose: (version: number) => void): readonly Node[] {
  // An export holds one version only.
  if (planVersion === undefined || versions.length === 0) return [];
  const choices = versions.map(({ version, participants }) => ({
    id: String(version),
    label: `Version ${version}: ${participants.length} participants`,
  }));
  return [
    element(
      'div',
      { class: 'bar' },
      chooser('Version of the plan', choices, String(planVersion), (version) => choose(Number(version))),
      element(
        'p',
        { class: 'soft' },
        'The plan was changed while the study ran. The results below are of one version only.',
      ),
    ),
  ];
}

new ResultsPage(pageElement('content', HTMLElement)).start();
