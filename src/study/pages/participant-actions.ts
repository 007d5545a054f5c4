import { offerDownload } from 'threepoint-ui/downloads';
import { pageFolder } from 'threepoint-ui/page-folder';
import type { ExperimenterClient } from '../client/study-client';
import { type OpenStudy, receiptText } from './experimenter-view';
import type { ParticipantActions } from './participant-row';
import { askForSentence } from './sentence-dialog';
import { askHowToVoid, isIn } from './void-block-dialog';

/** Does something with the server; resolves with a notice for the experimenter, or null for none. */
export type ServerAction = (client: ExperimenterClient) => Promise<string | null>;

export interface ParticipantActionOptions {
  /** Runs an action, and shows its notice or why it failed. */
  readonly attempt: (action: ServerAction) => Promise<void>;
  /** Returns the newest state of the study. */
  readonly newest: () => OpenStudy;
}

/** Downloads an export of a study; resolves with the notice. */
export async function download(
  client: ExperimenterClient,
  study: string,
  part: Parameters<ExperimenterClient['export']>[1],
): Promise<string> {
  const file = await client.export(study, part);
  offerDownload(file.name, 'application/zip', file.zip);
  return `${file.name} is in your downloads.`;
}

/** Returns what an experimenter can do about the participants of a study. */
export function participantActions(
  study: OpenStudy,
  { attempt, newest }: ParticipantActionOptions,
): ParticipantActions {
  const { plan } = study;
  const { id } = plan;

  async function voidBlock(participant: string): Promise<void> {
    const voided = await askHowToVoid(study, participant);
    if (!voided?.of) return;
    const { reason, repeat, participants, of } = voided;
    const present = participants.filter((one) => isIn(newest(), one, of));
    await attempt(async (client) => {
      for (const one of present) await client.command(id, one, { type: 'void-block', reason, repeat, of });
      const gone = participants.filter((one) => !present.includes(one));
      if (gone.length === 0) return `${present.join(', ')}: the block is being voided.`;
      throw new Error(`Not voided for ${gone.join(', ')}: block ${of.block} of ${of.task} is over there.`);
    });
  }

  async function stop(participant: string): Promise<void> {
    const reason = await askForSentence({
      title: `Stop the session of ${participant}`,
      label: 'Why? It is recorded. The session is over at once and cannot be taken up again; what was recorded stays.',
      confirm: 'Stop it',
    });
    if (reason === null) return;
    await attempt(async (client) => {
      await client.command(id, participant, { type: 'stop', by: 'experimenter', reason });
      return `${participant}: the session is being stopped.`;
    });
  }

  async function remark(participant: string): Promise<void> {
    const text = await askForSentence({
      title: `Remark on ${participant}`,
      label: 'It is stored with the participant’s records.',
      confirm: 'Store',
    });
    if (text === null) return;
    await attempt(async (client) => {
      await client.remark(id, participant, text);
      return `${participant}: remark stored.`;
    });
  }

  async function release(participant: string): Promise<void> {
    const question = `Release ${participant}? Another device may then go on; data that this one has not sent are lost to the server.`;
    if (!confirm(question)) return;
    await attempt(async (client) => {
      await client.release(id, participant);
      return `${participant} may be taken by another device.`;
    });
  }

  async function remove(participant: string): Promise<void> {
    const typed = await askForSentence({
      title: `Delete everything of ${participant}`,
      label: `This cannot be undone. Type ${participant} to delete its records, movements and commands.`,
      confirm: 'Delete',
    });
    if (typed === null) return;
    await attempt(async (client) => {
      if (typed !== participant) throw new Error(`Nothing was deleted: "${typed}" is not ${participant}.`);
      return `${participant} is deleted. ${receiptText(await client.delete(id, participant))}`;
    });
  }

  async function reinvite(participant: string): Promise<void> {
    const holder = plan.entry === 'open' ? 'all participants' : participant;
    const question = `Make a new link for ${holder}? The old link stops working; a place that is taken stays taken.`;
    if (!confirm(question)) return;
    await attempt(async (client) => {
      await client.reinvite(id, participant);
      return `${participant} has a new link.`;
    });
  }

  function copyLink(participant: string, link: string): Promise<void> {
    const address = new URL(link, `${pageFolder()}/`).href;
    return attempt(async () => {
      try {
        await navigator.clipboard.writeText(address);
        return `The link of ${participant} is in the clipboard: give it to ${participant} alone.`;
      } catch {
        // reason: a browser that lets no page write to the clipboard still shows the link
        return `The link of ${participant}: ${address}`;
      }
    });
  }

  return {
    command: (participant, command) =>
      void attempt(async (client) => {
        await client.command(id, participant, command);
        return `${participant}: “${command.type}” sent.`;
      }),
    voidBlock: (participant) => void voidBlock(participant),
    stop: (participant) => void stop(participant),
    remark: (participant) => void remark(participant),
    release: (participant) => void release(participant),
    exportZip: (participant) => void attempt((client) => download(client, id, { participant })),
    remove: (participant) => void remove(participant),
    copyLink: (participant, link) => void copyLink(participant, link),
    reinvite: (participant) => void reinvite(participant),
  };
}
