import { isPlayed, type Schedule } from '../../model/plan/schedule';
import type { ParticipantState } from '../../model/progress/study-api';

/**
 * Returns the seconds left of a participant's step; in a match of a group those of the page that reported last, for all
 * alike. null: the step has no limit.
 */
export function timeLeft(
  states: readonly ParticipantState[],
  { groups, steps }: Schedule,
  { session }: ParticipantState,
): number | null {
  if (!session) return null;
  const step = steps.find(({ id }) => id === session.step);
  const members = (step && isPlayed(step) && groups[step.task]?.members) || [];
  const playing = states.flatMap(({ participant, session: other }) =>
    other?.running && other.step === session.step && members.includes(participant) ? [other] : [],
  );
  const newest = playing.toSorted((a, b) => a.silence - b.silence)[0];
  return (session.running && newest ? newest : session).remainingSeconds;
}
