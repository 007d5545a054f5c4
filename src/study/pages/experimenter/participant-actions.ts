import { offerDownload, pageFolder } from 'threepoint-ui';
import type { ExperimenterClient } from '../../client/study-client';
import { type OpenStudy, receiptText } from './experimenter-view';
import { askForSentence, type SentenceDialog } from './input-dialog';
import type { ParticipantActions } from './participant-row';
import { askHowToVoid, isIn } from './void-block-dialog';

/** Does something with the server; resolves with a notice for the experimenter, or null for none. */
export type ServerAction = (client: ExperimenterClient) => Promise<string | null>;

/** Runs an action, and shows its notice or why it failed. */
type Attempt = (action: ServerAction) => Promise<void>;

export interface ParticipantActionOptions {
  readonly attempt: Attempt;
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

/** Asks for a sentence and acts with it; nothing happens if the experimenter cancels. */
async function withSentence(
  attempt: Attempt,
  question: SentenceDialog,
  act: (client: ExperimenterClient, sentence: string) => Promise<string>,
): Promise<void> {
  const sentence = await askForSentence(question);
  if (sentence !== null) await attempt((client) => act(client, sentence));
}

async function copyLink(participant: string, link: string): Promise<string> {
  const address = new URL(link, `${pageFolder()}/`).href;
  try {
    await navigator.clipboard.writeText(address);
    return `The link of ${participant} is in the clipboard: give it to ${participant} alone.`;
  } catch {
    // reason: a browser that lets no page write to the clipboard still shows the link
    return `The link of ${participant}: ${address}`;
  }
}

/** Returns the actions on a participant's running session. */
function sessionActions(
  study: OpenStudy,
  { attempt, newest }: ParticipantActionOptions,
): Pick<ParticipantActions, 'command' | 'voidBlock' | 'stop'> {
  const { id } = study.plan;

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

  return {
    command: (participant, command) =>
      void attempt(async (client) => {
        await client.command(id, participant, command);
        return `${participant}: “${command.type}” sent.`;
      }),
    voidBlock: (participant) => void voidBlock(participant),
    stop: (participant) =>
      void withSentence(
        attempt,
        {
          title: `Stop the session of ${participant}`,
          label:
            'Why? It is recorded. The session is over at once and cannot be taken up again; what was recorded stays.',
          confirm: 'Stop it',
        },
        async (client, reason) => {
          await client.command(id, participant, { type: 'stop', by: 'experimenter', reason });
          return `${participant}: the session is being stopped.`;
        },
      ),
  };
}

/** Returns the actions on a participant's place: its device and its link. */
function placeActions(
  { plan: { id, entry } }: OpenStudy,
  attempt: Attempt,
): Pick<ParticipantActions, 'release' | 'copyLink' | 'reinvite'> {
  return {
    release(participant) {
      const question = `Release ${participant}? Another device may then go on; data that this one has not sent are lost to the server.`;
      if (!confirm(question)) return;
      void attempt(async (client) => {
        await client.release(id, participant);
        return `${participant} may be taken by another device.`;
      });
    },
    copyLink: (participant, link) => void attempt(() => copyLink(participant, link)),
    reinvite(participant) {
      const holder = entry === 'open' ? 'all participants' : participant;
      const question = `Make a new link for ${holder}? The old link stops working; a place that is taken stays taken.`;
      if (!confirm(question)) return;
      void attempt(async (client) => {
        await client.reinvite(id, participant);
        return `${participant} has a new link.`;
      });
    },
  };
}

/** Returns the actions on what is stored of a participant. */
function recordActions(
  { plan: { id } }: OpenStudy,
  attempt: Attempt,
): Pick<ParticipantActions, 'remark' | 'exportZip' | 'remove'> {
  return {
    remark: (participant) =>
      void withSentence(
        attempt,
        {
          title: `Remark on ${participant}`,
          label: 'It is stored with the participant’s records.',
          confirm: 'Store',
        },
        async (client, text) => {
          await client.remark(id, participant, text);
          return `${participant}: remark stored.`;
        },
      ),
    exportZip: (participant) => void attempt((client) => download(client, id, { participant })),
    remove: (participant) =>
      void withSentence(
        attempt,
        {
          title: `Delete everything of ${participant}`,
          label: `This cannot be undone. Type ${participant} to delete its records, movements and commands.`,
          confirm: 'Delete',
        },
        async (client, typed) => {
          if (typed !== participant) throw new Error(`Nothing was deleted: "${typed}" is not ${participant}.`);
          return `${participant} is deleted. ${receiptText(await client.delete(id, participant))}`;
        },
      ),
  };
}

/** Returns what an experimenter can do about the participants of a study. */
export function participantActions(study: OpenStudy, options: ParticipantActionOptions): ParticipantActions {
  const { attempt } = options;
  return {
    ...sessionActions(study, options),
    ...placeActions(study, attempt),
    ...recordActions(study, attempt),
  };
}
