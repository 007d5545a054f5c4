import { element } from 'threepoint-ui';
import { scheduleFor } from '../../model/plan/schedule';
import type { TargetBlock } from '../../model/progress/study-api';
import { type OpenStudy, planOf } from './experimenter-view';
import { askForSentence } from './input-dialog';

/** The block to void. */
export interface VoidedBlock {
  readonly reason: string;
  readonly repeat: boolean;
  /** The participants whose block it is, several if they play it together. */
  readonly participants: readonly string[];
  /** null: the participant is in no block. */
  readonly of: TargetBlock | null;
}

/** Returns the place of a participant in the schedule of the plan that they follow. */
function placeOf(study: OpenStudy, participant: string) {
  const own = study.states.find((state) => state.participant === participant);
  const schedule = scheduleFor(planOf(study, own?.version), participant);
  const step = schedule.steps.find(({ id }) => id === own?.session?.step);
  return { schedule, block: step && 'task' in step ? { task: step.task, block: step.block } : null };
}

/** Returns whether a participant is in this block now. */
export function isIn(study: OpenStudy, participant: string, { task, block }: TargetBlock): boolean {
  const now = placeOf(study, participant).block;
  return now?.task === task && now.block === block;
}

/** Returns the participants who play the matches of the present block with this one and are in it too. */
function companions(study: OpenStudy, participant: string): readonly string[] {
  const { schedule, block } = placeOf(study, participant);
  if (!block) return [];
  const members = schedule.groups[block.task]?.members ?? [];
  return members.filter((member) => member !== participant && isIn(study, member, block));
}

const option = (text: string) => {
  const input = element('input', { type: 'checkbox', checked: true });
  return { input, node: element('label', { class: 'inline' }, input, element('span', {}, text)) };
};

/** Asks why and how a participant's present block is voided; resolves with null if it is cancelled. */
export async function askHowToVoid(study: OpenStudy, participant: string): Promise<VoidedBlock | null> {
  const others = companions(study, participant);
  const repeat = option('Repeat the block at once (otherwise the next one follows)');
  const together = option(
    `Also for ${others.join(' and ')}: they play the match together, and a repeated match waits for all`,
  );
  const reason = await askForSentence({
    title: `Void the present block of ${participant}`,
    label: 'Why? It is recorded and stated in the results.',
    confirm: 'Void it',
    extra: [repeat.node, ...(others.length > 0 ? [together.node] : [])],
  });
  if (reason === null) return null;
  const participants = [participant, ...(together.input.checked ? others : [])];
  return { reason, repeat: repeat.input.checked, participants, of: placeOf(study, participant).block };
}
