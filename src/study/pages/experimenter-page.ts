import 'threepoint-ui/styles/document.css';
import { reasonOf } from 'threepoint/core/errors/reasons';
import { offerDownload } from 'threepoint-ui/downloads';
import { element, pageElement } from 'threepoint-ui/element';
import { pageFolder } from 'threepoint-ui/page-folder';
import { sentence } from 'threepoint-ui/phrase-parts';
import { type ExperimenterClient, ServerRefusal } from '../client/study-client';
import type { StudyPlan } from '../model/plan';
import type { StudyCommand, StudyInfo } from '../model/study-api';
import { statedInWords } from '../simulation/simulate-study';
import {
  type NewStudy,
  type NewStudyActions,
  newStudyCard,
  type OpenStudy,
  openStudy,
  receiptText,
  type StudyActions,
} from './experimenter-view';
import { planToBegin } from './new-study';
import { askForRehearsal } from './rehearsal-dialog';
import { rehearse } from './rehearse';
import { askForSentence } from './sentence-dialog';
import { StudyAccess } from './study-access';
import { askHowToVoid, isIn } from './void-block-dialog';

/** How often the states are asked for [ms]. */
const refreshEveryMs = 1500;

/** The experimenter's page: one study, its participants, and what can be done about them. */
class ExperimenterPage {
  readonly #content: HTMLElement;
  readonly #access = new StudyAccess(
    () => this.#render(),
    (study) => void this.#open(study),
  );
  #study: OpenStudy | null = null;
  /** Whether the study to be begun is marked as simulated. */
  #simulated = false;
  #notice = '';
  #complaint = '';
  #online = true;
  #shownKey = '';
  /** A button must not go away between press and release. */
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
        // The click follows the release.
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
      this.#study = { ...info, receipts, states: await client.participants(id), toldAt: Date.now() / 1000 };
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
        const toldAt = Date.now() / 1000;
        const receipts = await client.receipts(study.plan.id);
        // Another study may have been opened meanwhile.
        if (this.#study?.plan.id === study.plan.id) this.#study = { ...this.#study, states, toldAt, receipts };
        this.#online = true;
      } catch (error) {
        this.#online = false;
        if (error instanceof ServerRefusal) this.#complaint = error.message;
      }
    }
    this.#render();
  }

  /** Does something with the server, and says what it answers or why it failed; null: nothing. */
  async #attempt(action: (client: ExperimenterClient) => Promise<string | null>): Promise<void> {
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
      const added = planToBegin(await json(), simulated);
      const info = await addOrChange(client, added, simulated);
      if (!info) return `Nothing was changed: the study “${added.id}” keeps its plan.`;
      await this.#access.list(client);
      await this.#open(added.id);
      return `${name} is on this server${info.versions.length > 1 ? `, as version ${info.version} of the plan` : ''}.`;
    });
  }

  #actionsOn(study: OpenStudy): StudyActions {
    const { plan } = study;
    const { id } = plan;
    return {
      rehearse: () => void this.#rehearse(plan),
      deleteSimulated: () => void this.#deleteSimulated(id),
      exportAll: (version) => void this.#exportZip(id, { version }),
      exportZip: (participant) => void this.#exportZip(id, { participant }),
      command: (participant, command) => void this.#command(id, participant, command),
      voidBlock: (participant) => void this.#voidBlock(study, participant),
      stop: (participant) => void this.#stop(id, participant),
      remark: (participant) => void this.#remark(id, participant),
      release: (participant) => void this.#release(id, participant),
      remove: (participant) => void this.#remove(id, participant),
      copyLink: (participant, link) => void this.#copyLink(participant, link),
      reinvite: (participant) => void this.#reinvite(id, participant, plan.entry === 'open'),
    };
  }

  async #rehearse(plan: StudyPlan): Promise<void> {
    const rehearsal = await askForRehearsal(plan);
    if (!rehearsal) return;
    await this.#attempt(async (client) => {
      const onProgress = (done: number, all: number) => {
        this.#notice = `Rehearsing: ${done} of ${all} simulated participants.`;
        this.#render();
      };
      const id = await rehearse(client, plan, { ...rehearsal, at: Date.now() / 1000, onProgress });
      await this.#access.list(client);
      await this.#open(id);
      return `Put in: ${statedInWords(rehearsal.effects)} The results of the rehearsal can be looked at now.`;
    });
  }

  async #deleteSimulated(study: string): Promise<void> {
    if (!confirm(`Delete “${study}” and everything in it? It is simulated: nothing of people is in it.`)) return;
    await this.#attempt(async (client) => {
      await client.deleteSimulated(study);
      this.#study = null;
      await this.#access.list(client);
      return `“${study}” is deleted.`;
    });
  }

  #command(study: string, participant: string, command: StudyCommand): Promise<void> {
    return this.#attempt(async (client) => {
      await client.command(study, participant, command);
      return `${participant}: “${command.type}” sent.`;
    });
  }

  async #reinvite(study: string, participant: string, oneForAll: boolean): Promise<void> {
    const whose = oneForAll ? 'all participants' : participant;
    const question = `Make a new link for ${whose}? The old one opens nothing any more; a place that is taken stays taken.`;
    if (!confirm(question)) return;
    await this.#attempt(async (client) => {
      await client.reinvite(study, participant);
      return `${participant} has a new link.`;
    });
  }

  #copyLink(participant: string, link: string): Promise<void> {
    const address = new URL(link, `${pageFolder()}/`).href;
    return this.#attempt(async () => {
      try {
        await navigator.clipboard.writeText(address);
        return `The link of ${participant} is in the clipboard: give it to ${participant} alone.`;
      } catch {
        // reason: a browser that lets no page write to the clipboard still shows what is to be copied
        return `The link of ${participant}: ${address}`;
      }
    });
  }

  async #voidBlock(study: OpenStudy, participant: string): Promise<void> {
    const voided = await askHowToVoid(study, participant);
    if (!voided?.of) return;
    const { reason, repeat, participants, of } = voided;
    const { id } = study.plan;
    // The participant may have gone on while the reason was written.
    const now = this.#study?.plan.id === id ? this.#study : study;
    const here = participants.filter((one) => isIn(now, one, of));
    await this.#attempt(async (client) => {
      for (const one of here) await client.command(id, one, { type: 'void-block', reason, repeat, of });
      const gone = participants.filter((one) => !here.includes(one));
      if (gone.length === 0) return `${here.join(', ')}: the block is being voided.`;
      throw new Error(`Not voided for ${gone.join(', ')}: block ${of.block} of ${of.task} is over there.`);
    });
  }

  async #stop(study: string, participant: string): Promise<void> {
    const reason = await askForSentence({
      title: `Stop the session of ${participant}`,
      label: 'Why? It is recorded. The session is over at once and cannot be taken up again; what was recorded stays.',
      confirm: 'Stop it',
    });
    if (reason === null) return;
    await this.#attempt(async (client) => {
      await client.command(study, participant, { type: 'stop', by: 'experimenter', reason });
      return `${participant}: the session is being stopped.`;
    });
  }

  async #remark(study: string, participant: string): Promise<void> {
    const text = await askForSentence({
      title: `Remark on ${participant}`,
      label: 'It is stored with the participant’s records.',
      confirm: 'Store',
    });
    if (text === null) return;
    await this.#attempt(async (client) => {
      await client.remark(study, participant, text);
      return `${participant}: remark stored.`;
    });
  }

  async #release(study: string, participant: string): Promise<void> {
    const question = `Release ${participant}? Another device may then go on; what this one has not sent is lost to the server.`;
    if (!confirm(question)) return;
    await this.#attempt(async (client) => {
      await client.release(study, participant);
      return `${participant} may be taken by another device.`;
    });
  }

  #exportZip(study: string, of: Parameters<ExperimenterClient['export']>[1]): Promise<void> {
    return this.#attempt(async (client) => {
      const file = await client.export(study, of);
      offerDownload(file.name, 'application/zip', file.zip);
      return `${file.name} is in your downloads.`;
    });
  }

  async #remove(study: string, participant: string): Promise<void> {
    const typed = await askForSentence({
      title: `Delete everything of ${participant}`,
      label: `This cannot be undone. Type ${participant} to delete its records, movements and commands.`,
      confirm: 'Delete',
    });
    if (typed === null) return;
    if (typed !== participant) {
      this.#complaint = `Nothing was deleted: "${typed}" is not ${participant}.`;
      this.#render();
      return;
    }
    await this.#attempt(
      async (client) => `${participant} is deleted. ${receiptText(await client.delete(study, participant))}`,
    );
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
    // An open list, or a field that is being typed in, is not taken away.
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
        this.#access.forgetButton(),
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

/** Adds a study; where one of the same id has begun with another plan, as a new version of it, if the experimenter wants that. null: no. */
async function addOrChange(client: ExperimenterClient, plan: StudyPlan, simulated: boolean): Promise<StudyInfo | null> {
  try {
    return await client.addStudy(plan, simulated);
  } catch (error) {
    if (!(error instanceof ServerRefusal) || error.field !== 'newVersion') throw error;
    if (!confirm(`${sentence(error.message)}\n\nMake it a new version? Results keep the versions apart.`)) return null;
    return client.addStudy(plan, simulated, true);
  }
}

const anotherStudy = () =>
  element(
    'p',
    { style: 'margin-top:24px' },
    element('a', { href: './experimenter.html' }, 'Begin or open another study'),
  );

/** Builds a table anew and gives the focus back to the button of the same row and label that had it. */
function keepingFocus(content: HTMLElement, build: () => void): void {
  const focused = document.activeElement?.closest('tr')?.rowIndex;
  const label = document.activeElement?.textContent;
  build();
  if (focused === undefined || !label) return;
  const buttons = [...(content.querySelectorAll('tr')[focused]?.querySelectorAll('button') ?? [])];
  buttons.find(({ textContent }) => textContent === label)?.focus();
}

void new ExperimenterPage(pageElement('content', HTMLElement)).start();
