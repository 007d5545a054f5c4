import 'threepoint-ui/styles/document.css';
import { reasonOf } from 'threepoint/core';
import { element, formatSentence, pageElement } from 'threepoint-ui';
import { type ExperimenterClient, ServerRefusal } from '../../client/study-client';
import { checkedPlan, type StudyPlan } from '../../model/plan/plan';
import type { StudyInfo } from '../../model/progress/study-api';
import { effectsInWords, simulatedPlan } from '../../simulation/simulate-study';
import { ExperimenterAccess } from '../experimenter-access';
import {
  type NewStudy,
  type NewStudyActions,
  newStudyCard,
  type OpenStudy,
  openStudy,
  type StudyActions,
} from './experimenter-view';
import { download, participantActions, type ServerAction } from './participant-actions';
import { askForSimulation } from './simulation-dialog';
import { storeSimulation } from './store-simulation';

/** The interval at which states are requested [ms]. */
const refreshEveryMs = 1500;

/** The experimenter's page: one study, its participants and the actions on them. */
class ExperimenterPage {
  readonly #content: HTMLElement;
  readonly #access = new ExperimenterAccess(
    () => this.#render(),
    (study) => void this.#open(study),
  );
  #study: OpenStudy | null = null;
  /** Whether the new study is marked as simulated. */
  #simulated = false;
  #notice = '';
  #complaint = '';
  #online = true;
  #shownKey = '';
  /** Whether a pointer is pressed. A button must not be replaced between press and release. */
  #pressing = false;

  constructor(content: HTMLElement) {
    this.#content = content;
  }

  async start(): Promise<void> {
    document.addEventListener('pointerdown', () => {
      this.#pressing = true;
    });
    for (const event of ['pointerup', 'pointercancel']) {
      document.addEventListener(event, () => {
        // The click event follows the release.
        setTimeout(() => {
          this.#pressing = false;
        }, 0);
      });
    }
    this.#render();
    await this.#access.resume();
    setInterval(() => {
      if (document.visibilityState === 'visible' && this.#study) void this.#refresh();
    }, refreshEveryMs);
  }

  async #open(id: string): Promise<void> {
    const { client } = this.#access;
    if (!client || !id) return;
    try {
      const { records: _, ...info } = await this.#access.open(client, id);
      const receipts = await client.receipts(id);
      this.#study = { ...info, receipts, states: await client.participants(id), receivedAt: Date.now() / 1000 };
      this.#complaint = '';
    } catch (error) {
      this.#complaint = reasonOf(error);
    }
    this.#render();
  }

  async #refresh(): Promise<void> {
    const { client } = this.#access;
    const study = this.#study;
    if (client && study) {
      try {
        const states = await client.participants(study.plan.id);
        const receivedAt = Date.now() / 1000;
        const receipts = await client.receipts(study.plan.id);
        // Another study may have been opened in the meantime.
        if (this.#study?.plan.id === study.plan.id) this.#study = { ...this.#study, states, receivedAt, receipts };
        this.#online = true;
      } catch (error) {
        this.#online = false;
        if (error instanceof ServerRefusal) this.#complaint = error.message;
      }
    }
    this.#render();
  }

  /** Runs an action with the server, and shows its notice or why it failed. */
  async #attempt(action: ServerAction): Promise<void> {
    const { client } = this.#access;
    if (!client) return;
    try {
      this.#notice = (await action(client)) ?? '';
      this.#complaint = '';
    } catch (error) {
      this.#complaint = reasonOf(error);
    }
    await this.#refresh();
  }

  readonly #newStudyActions: NewStudyActions = {
    begin: (study) => void this.#begin(study),
    mark: (simulated) => {
      this.#simulated = simulated;
    },
  };

  #begin({ name, simulated, json }: NewStudy): Promise<void> {
    return this.#attempt(async (client) => {
      const plan = checkedPlan(JSON.parse(await json()));
      const added = simulated ? simulatedPlan(plan) : plan;
      const info = await addOrChange(client, added, simulated);
      if (!info) return `Nothing was changed: the study “${added.id}” keeps its plan.`;
      await this.#access.list(client);
      await this.#open(added.id);
      return `${name} is on this server${info.versions.length > 1 ? `, as version ${info.version} of the plan` : ''}.`;
    });
  }

  #actionsOn(study: OpenStudy): StudyActions {
    const options = {
      attempt: (action: ServerAction) => this.#attempt(action),
      // The participant may have gone on while the experimenter wrote.
      newest: () => (this.#study?.plan.id === study.plan.id ? this.#study : study),
    };
    return {
      ...participantActions(study, options),
      exportAll: (version) => void this.#attempt((client) => download(client, study.plan.id, { version })),
      simulate: () => void this.#simulate(study.plan),
      deleteSimulated: () => void this.#deleteSimulated(study.plan.id),
    };
  }

  async #simulate(plan: StudyPlan): Promise<void> {
    const options = await askForSimulation(plan);
    if (!options) return;
    await this.#attempt(async (client) => {
      const onProgress = (done: number, all: number) => {
        this.#notice = `Simulating: ${done} of ${all} participants.`;
        this.#render();
      };
      const id = await storeSimulation(client, plan, { ...options, at: Date.now() / 1000, onProgress });
      await this.#access.list(client);
      await this.#open(id);
      return `Effects: ${effectsInWords(options.effects)} The results of the simulation can be looked at now.`;
    });
  }

  async #deleteSimulated(study: string): Promise<void> {
    if (!confirm(`Delete “${study}” and everything in it? It is simulated: it has no data of people.`)) return;
    await this.#attempt(async (client) => {
      await client.deleteSimulated(study);
      this.#study = null;
      await this.#access.list(client);
      return `“${study}” is deleted.`;
    });
  }

  #render(): void {
    if (!this.#access.client) {
      this.#content.replaceChildren(element('section', { class: 'card' }, this.#access.form()));
      return;
    }
    const now = Date.now() / 1000;
    const key = JSON.stringify([
      ...[this.#access.listed, this.#study, this.#notice, this.#complaint, this.#online],
      Math.floor(now),
    ]);
    // An open list and a focused field are not replaced.
    if (key === this.#shownKey || this.#pressing || document.activeElement instanceof HTMLSelectElement) return;
    this.#shownKey = key;
    keepingFocus(this.#content, () => this.#content.replaceChildren(...this.#parts(now)));
  }

  #parts(now: number): readonly Node[] {
    const study = this.#study;
    return [
      element(
        'section',
        { class: 'card bar' },
        this.#access.select(study?.plan.id, 'No studies yet', (id) => void this.#open(id)),
        this.#access.signOutButton(),
        element(
          'span',
          { class: this.#online ? 'badge live' : 'badge lost' },
          this.#online ? 'connected' : 'no connection',
        ),
      ),
      element('p', { role: 'status', class: 'soft' }, this.#notice),
      element('p', { role: 'alert', class: 'complaint' }, this.#complaint),
      ...(study
        ? [...openStudy(study, now, this.#actionsOn(study)), anotherStudy()]
        : [newStudyCard(this.#simulated, this.#newStudyActions)]),
    ];
  }
}

/**
 * Adds a study. If one of the same id has begun with another plan, the experimenter is asked whether to add a new
 * version; resolves with null if not.
 */
async function addOrChange(client: ExperimenterClient, plan: StudyPlan, simulated: boolean): Promise<StudyInfo | null> {
  try {
    return await client.addStudy(plan, simulated);
  } catch (error) {
    if (!(error instanceof ServerRefusal) || error.field !== 'newVersion') throw error;
    if (!confirm(`${formatSentence(error.message)}\n\nMake it a new version? Results keep the versions apart.`))
      return null;
    return client.addStudy(plan, simulated, true);
  }
}

const anotherStudy = () =>
  element(
    'p',
    { style: 'margin-top:24px' },
    element('a', { href: './experimenter.html' }, 'Begin or open another study'),
  );

/** Rebuilds the content and restores the focus to the button of the same row and label. */
function keepingFocus(content: HTMLElement, build: () => void): void {
  const focused = document.activeElement?.closest('tr')?.rowIndex;
  const label = document.activeElement?.textContent;
  build();
  if (focused === undefined || !label) return;
  const buttons = [...(content.querySelectorAll('tr')[focused]?.querySelectorAll('button') ?? [])];
  buttons.find(({ textContent }) => textContent === label)?.focus();
}

void new ExperimenterPage(pageElement('content', HTMLElement)).start();
