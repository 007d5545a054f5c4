import type { StudyPlan } from '../../model/plan/plan';
import type { StudyRecord, TrialRecord } from '../../model/records/study-record';
import type { TrialAbsence } from '../../model/records/trial-log';
import { trialsIn } from '../../model/tables/study-tables';

/** The most by which a trial may end before its time [s]; pages show the end of a match some frames apart. */
const toleranceSeconds = 1;
/** The most by which the pages of a group may time one absence apart [s]. */
const absenceTolerance = 0.1;

const placeText = ({ participant, body: { place, repetition } }: TrialRecord): string =>
  `${participant}, ${place.task}, block ${place.block}, run ${place.run}, trial ${repetition}`;

/** Returns the complaint about a trial that counts although it ended before its time. */
function shortTrials(trials: readonly TrialRecord[], plan: StudyPlan): readonly string[] {
  return trials.flatMap((trial) => {
    const { ended, seconds } = trial.body.outcome;
    const limit = plan.tasks.find(({ id }) => id === trial.body.place.task)?.trialSeconds ?? 0;
    if (ended !== 'time' || seconds >= limit - toleranceSeconds) return [];
    const lasted = `it ended at its time after ${seconds.toFixed(1)} s of ${limit}`;
    return [`${placeText(trial)}: ${lasted}. An incomplete trial must not be counted.`];
  });
}

const absencesText = (absences: readonly TrialAbsence[]): string =>
  absences.length === 0
    ? 'none'
    : absences.map(({ participants, seconds }) => `${participants.join(' ')} for ${seconds.toFixed(1)} s`).join(', ');

function areAlike(some: readonly TrialAbsence[], others: readonly TrialAbsence[]): boolean {
  const near = (a: number, b: number) => Math.abs(a - b) <= absenceTolerance;
  return (
    some.length === others.length &&
    some.every((one, index) => {
      const other = others[index] as TrialAbsence;
      const sameNames = one.participants.join(' ') === other.participants.join(' ');
      return sameNames && near(one.time, other.time) && near(one.seconds, other.seconds);
    })
  );
}

/** Returns the complaints about trials of one match that list different absences. */
function differingAbsences(trials: readonly TrialRecord[]): readonly string[] {
  const first = new Map<string, TrialRecord>();
  return trials.flatMap((trial) => {
    const { place, group, condition, repetition } = trial.body;
    const match = [place.task, group, place.block, place.run, condition, repetition].join(' ');
    const known = first.get(match);
    if (!known) {
      first.set(match, trial);
      return [];
    }
    const [theirs = [], own = []] = [known.body.outcome.absences, trial.body.outcome.absences];
    if (areAlike(theirs, own)) return [];
    const lists = `${absencesText(own)}, where ${known.participant} lists ${absencesText(theirs)}`;
    return [`${placeText(trial)}: it lists as absences ${lists}. One match has one list.`];
  });
}

/** Returns the complaints about trials that break the rules of incomplete trials and of absences. */
export function trialProblems(records: readonly StudyRecord[], plan: StudyPlan): readonly string[] {
  const trials = trialsIn(records);
  const counted = trials.filter(({ excluded }) => !excluded).map(({ record }) => record);
  return [...shortTrials(counted, plan), ...differingAbsences(trials.map(({ record }) => record))];
}
