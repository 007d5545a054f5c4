import { scheduleFor } from '../../model/plan/schedule';
import { currentStep, remainingSeconds, resumed, sinceReport } from '../../model/progress/progress';
import type { ParticipantState, PlanVersion } from '../../model/progress/study-api';
import { StudyCommands } from './commands';
import { type DatabaseOptions, StudyDatabase } from './database';
import { StudyDeletion } from './deletion';
import { StudyMotion } from './motion';
import { type PlaceRow, StudyPlaces } from './places';
import { StudyPlans } from './plans';
import { StudyRecords } from './records';
import { StudySoftware } from './software';

/**
 * Studies and what was recorded in them. What returns is stored and outlives the process; that it outlives a power cut too, `flushed` says,
 * and nothing is acknowledged before. Times are seconds since 1970, given by the caller.
 */
export interface StudyStore {
  readonly plans: StudyPlans;
  readonly places: StudyPlaces;
  readonly records: StudyRecords;
  readonly motion: StudyMotion;
  readonly commands: StudyCommands;
  readonly software: StudySoftware;
  readonly deletion: StudyDeletion;
  overview(study: string, now: number): readonly ParticipantState[];
  /** What `body` reads, all as of one moment. */
  snapshot<T>(body: () => T): T;
  /** Resolves when everything until now is on the disk; those who ask while the disk is at work wait for one flush together. */
  flushed(): Promise<void>;
  /** Overwrites deleted data that could not be overwritten when it was deleted; false: it still cannot be. */
  forgetDeleted(): boolean;
  close(): void;
}

/** A place as the experimenter sees it, at this time [s]. */
function stateOf(row: PlaceRow, { plan, version }: PlanVersion, records: number, now: number): ParticipantState {
  const schedule = scheduleFor(plan, row.participant);
  const silence = now - (row.progress_at ?? now);
  const progress = row.progress === null ? null : sinceReport(resumed(schedule, row.progress), silence);
  return {
    participant: row.participant,
    version,
    invitation: row.invitation,
    claimed: row.token_hash !== null,
    withdrawn: row.withdrawn === 1,
    records,
    session: progress && {
      step: progress.step,
      kind: currentStep(schedule, progress).kind,
      running: progress.running,
      paused: progress.paused,
      unwell: progress.unwell ?? false,
      stopped: progress.stopped ?? false,
      remainingSeconds: remainingSeconds(schedule, progress, now),
      silence,
    },
  };
}

/** Studies leave room for the rest of the machine: beyond so much [bytes] writes are refused as "full". */
const mostStoredBytes = 16 * 2 ** 30;

/** Opens the database in this file, makes it where there is none, and brings it up to date; `readOnly` opens what is there already. */
export function openStudyStore(
  file: string,
  { mostBytes = mostStoredBytes, readOnly = false }: Partial<DatabaseOptions> = {},
): StudyStore {
  const database = new StudyDatabase(file, { mostBytes, readOnly });
  const plans = new StudyPlans(database);
  const places = new StudyPlaces(database, plans);
  const records = new StudyRecords(database, plans, places);
  const motion = new StudyMotion(database, places);
  const commands = new StudyCommands(database, places);
  return {
    ...{ plans, places, records, motion, commands },
    software: new StudySoftware(database),
    deletion: new StudyDeletion({ database, plans, places, records, motion, commands }),
    overview(study, now) {
      const { version: newest, versions } = plans.get(study);
      return places.all(study).map((row) => {
        const followed = versions.find(({ version }) => version === (row.plan_version ?? newest)) as PlanVersion;
        return stateOf(row, followed, records.count(study, row.participant), now);
      });
    },
    snapshot: (body) => database.snapshot(body),
    flushed: () => database.flushed(),
    forgetDeleted: () => !database.holdsDeleted || database.forgetDeleted(),
    close: () => database.close(),
  };
}
