import { trialProblems } from '../../../src/study/cli/verify/trial-rules';
import { type AbsenceRule, absenceRuleOf, type StudyPlan, type StudyTask } from '../../../src/study/model/plan/plan';
import { isPlayed, scheduleFor } from '../../../src/study/model/plan/schedule';
import type { StudyRecord } from '../../../src/study/model/records/study-record';
import { studyTables } from '../../../src/study/model/tables/study-tables';
import { paperPlan, session } from './studies';

/** The paper's study with ball matches of this length alone, without practice, for one group. */
export function groupPlan(trialSeconds: number, absence: AbsenceRule): StudyPlan {
  const plan = paperPlan();
  const tasks = plan.tasks
    .filter(({ id }) => id === 'ball')
    .map((task) => ({ ...task, trialSeconds, absence, tutorial: { ...task.tutorial, when: 'never' as const } }));
  return { ...plan, participants: 3, tasks };
}

/** Returns the members of the group of such a plan, and what its matches do when one is away. */
export function groupIn(plan: StudyPlan) {
  const [task] = plan.tasks as [StudyTask];
  const { members = [] } = scheduleFor(plan, 'P01').groups[task.id] ?? {};
  return { task, members, ...absenceRuleOf(task) };
}

/** Returns the session of a participant at the sheet before the first match. */
export function groupSession(plan: StudyPlan, participant: string) {
  const one = session(scheduleFor(plan, participant));
  one.doUntil(isPlayed);
  return one;
}

export type GroupSession = ReturnType<typeof groupSession>;
export type GroupPlan = StudyPlan;
export type GroupRecord = StudyRecord;

type Row = Readonly<Record<'participant' | 'absences' | 'excluded' | 'event' | 'text' | 'ended', string>> &
  Readonly<Record<'attempt' | 'seconds' | 'second' | 'absent_seconds', number>> & { readonly from: number | null };

/** Returns the rows of a table of these records. */
export const rowsOf = (records: readonly StudyRecord[], plan: StudyPlan, name: 'trials' | 'events') =>
  (studyTables(records, plan).find((table) => table.name === name)?.rows ?? []) as unknown as readonly Row[];

/** Returns the complaints of `study:verify` about the trials. */
export { trialProblems };
