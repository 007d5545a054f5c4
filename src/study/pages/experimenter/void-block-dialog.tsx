import { Tick } from 'threepoint-ui/controls';
import { scheduleFor } from '../../model/plan/schedule';
import type { TargetBlock } from '../../model/progress/study-api';
import { type OpenStudy, planOf } from './experimenter-state';
import { askInDialog, sentenceOf } from './input-dialog';

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

/**
 * Asks why and how a participant's present block is voided; resolves with null if it is cancelled. `of` is the block,
 * or null if the participant is in none.
 */
export async function askHowToVoid(study: OpenStudy, participant: string) {
  const others = companions(study, participant);
  const together = `Also for ${others.join(' and ')}: they play the match together, and a repeated match waits for all`;
  const fields = await askInDialog({
    title: `Void the present block of ${participant}`,
    sentence: 'Why? It is recorded and stated in the results.',
    confirm: 'Void it',
    content: (
      <>
        <Tick name="repeat" defaultChecked label="Repeat the block at once (otherwise the next one follows)" />
        {others.length > 0 && <Tick name="together" defaultChecked label={together} />}
      </>
    ),
  });
  if (!fields) return null;
  return {
    reason: sentenceOf(fields),
    repeat: fields.has('repeat'),
    participants: [participant, ...(fields.has('together') ? others : [])],
    of: placeOf(study, participant).block,
  };
}
