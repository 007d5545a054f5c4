import { offerDownload, pageFolder } from 'threepoint-ui';
import type { ExperimenterClient } from '../../client/study-client';
import type { Receipt, StudyCommand } from '../../model/progress/study-api';
import { attempt, study } from './experimenter-state';
import { askInDialog, sentenceOf } from './input-dialog';
import { askHowToVoid, isIn } from './void-block-dialog';

export const receiptText = ({ number, participant, reason, records, motionFiles, at }: Receipt) =>
  `Receipt ${number}: ${participant}, ${reason}, ${records} records and ${motionFiles} recordings, ${new Date(at * 1000).toLocaleString()}`;

/** Downloads an export of the open study. */
export const download = (part: Parameters<ExperimenterClient['export']>[1]) =>
  attempt(async (server, id) => {
    const file = await server.export(id, part);
    offerDownload(file.name, 'application/zip', file.zip);
    return `${file.name} is in your downloads.`;
  });

/** Asks for a sentence and acts with it; nothing happens if the experimenter cancels. */
async function withSentence(
  question: { readonly title: string; readonly sentence: string; readonly confirm: string },
  act: (server: ExperimenterClient, id: string, sentence: string) => Promise<string>,
): Promise<void> {
  const fields = await askInDialog(question);
  if (fields) await attempt((server, id) => act(server, id, sentenceOf(fields)));
}

export const sendCommand = (participant: string, command: StudyCommand) =>
  attempt(async (server, id) => {
    await server.command(id, participant, command);
    return `${participant}: “${command.type}” sent.`;
  });

/** Voids a participant's present block, and that of those who play it together. */
export async function voidBlock(participant: string): Promise<void> {
  const voided = study.value && (await askHowToVoid(study.value, participant));
  if (!voided?.of) return;
  const { reason, repeat, participants, of } = voided;
  await attempt(async (server, id) => {
    // The participant may have gone on while the experimenter wrote.
    const present = participants.filter((one) => study.value && isIn(study.value, one, of));
    for (const one of present) await server.command(id, one, { type: 'void-block', reason, repeat, of });
    const gone = participants.filter((one) => !present.includes(one));
    if (gone.length === 0) return `${present.join(', ')}: the block is being voided.`;
    throw new Error(`Not voided for ${gone.join(', ')}: block ${of.block} of ${of.task} is over there.`);
  });
}

export const stop = (participant: string) =>
  withSentence(
    {
      title: `Stop the session of ${participant}`,
      sentence: 'Why? It is recorded. The session ends at once and cannot be resumed. Its records stay.',
      confirm: 'Stop it',
    },
    async (server, id, reason) => {
      await server.command(id, participant, { type: 'stop', by: 'experimenter', reason });
      return `${participant}: the session is being stopped.`;
    },
  );

/** Lets another device take a participant's place. */
export async function release(participant: string): Promise<void> {
  const question = `Release ${participant}? Another device may then continue. Data that this device has not sent will be lost.`;
  if (!confirm(question)) return;
  await attempt(async (server, id) => {
    await server.release(id, participant);
    return `${participant} may be taken by another device.`;
  });
}

export const copyLink = (participant: string, link: string) =>
  attempt(async () => {
    const address = new URL(link, `${pageFolder()}/`).href;
    try {
      await navigator.clipboard.writeText(address);
      return `The link of ${participant} is in the clipboard: give it to ${participant} alone.`;
    } catch {
      // reason: a browser that lets no page write to the clipboard still shows the link
      return `The link of ${participant}: ${address}`;
    }
  });

/** Replaces a participant's link; in a study with an open entry, that of all participants. */
export async function reinvite(participant: string): Promise<void> {
  const holder = study.value?.plan.entry === 'open' ? 'all participants' : participant;
  const question = `Make a new link for ${holder}? The old link stops working; a place that is taken stays taken.`;
  if (!confirm(question)) return;
  await attempt(async (server, id) => {
    await server.reinvite(id, participant);
    return `${participant} has a new link.`;
  });
}

export const remark = (participant: string) =>
  withSentence(
    { title: `Remark on ${participant}`, sentence: 'It is stored with the participant’s records.', confirm: 'Store' },
    async (server, id, text) => {
      await server.remark(id, participant, text);
      return `${participant}: remark stored.`;
    },
  );

export const remove = (participant: string) =>
  withSentence(
    {
      title: `Delete everything of ${participant}`,
      sentence: `This cannot be undone. Type ${participant} to delete its records, movements and commands.`,
      confirm: 'Delete',
    },
    async (server, id, typed) => {
      if (typed !== participant) throw new Error(`Nothing was deleted: "${typed}" is not ${participant}.`);
      return `${participant} is deleted. ${receiptText(await server.delete(id, participant))}`;
    },
  );
