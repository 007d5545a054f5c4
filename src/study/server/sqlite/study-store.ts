import type { Software } from 'threepoint-http';
import { scheduleFor } from '../../model/plan/schedule';
import { currentStep, remainingSeconds, resumed, sinceReport } from '../../model/progress/progress';
import type { ParticipantState, PlanVersion } from '../../model/progress/study-api';
import type { ServedSoftware, SoftwareStorage, StoredStudy } from '../study-storage';
import { StudyDeletion } from './deletion';
import { StudyCommands } from './study-commands';
import { type DatabaseOptions, StudyDatabase } from './study-database';
import { StudyMotion } from './study-motion';
import { type PlaceRow, StudyPlaces } from './study-places';
import { StudyPlans } from './study-plans';
import { StudyRecords } from './study-records';

/** The studies in SQLite. */
export type StudyStore = ReturnType<typeof openStudyStore>;

/** Returns the state of a place for the experimenter at this time [s]. */
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
      unwell: progress.unwell,
      waiting: progress.waiting,
      stopped: progress.stopped,
      remainingSeconds: remainingSeconds(schedule, progress, now),
      silence,
    },
  };
}

class StudySoftware implements SoftwareStorage {
  readonly #database: StudyDatabase;

  constructor(database: StudyDatabase) {
    this.#database = database;
  }

  note(software: Software, at: number): void {
    const text = JSON.stringify(software);
    const last = this.#database.get<{ software: string }>('SELECT software FROM software ORDER BY number DESC LIMIT 1');
    if (last?.software === text) return;
    this.#database.transaction(() => {
      this.#database.run('INSERT INTO software (software, since) VALUES (?, ?)', text, at);
    });
  }

  since(at: number): readonly ServedSoftware[] {
    const all = this.#database
      .all<{ software: string; since: number }>('SELECT software, since FROM software ORDER BY number')
      .map(({ software, since }) => ({ since, ...(JSON.parse(software) as Software) }));
    return all.filter((_, index) => (all[index + 1]?.since ?? Number.POSITIVE_INFINITY) > at);
  }
}

/** The size beyond which writes are refused as "full" [bytes], to leave room for the rest of the machine. */
const maxStoredBytes = 16 * 2 ** 30;

/** Opens the database in this file, creates it if missing, and brings it up to date; `readOnly`: an existing one. */
export function openStudyStore(
  file: string,
  { maxBytes = maxStoredBytes, readOnly = false }: Partial<DatabaseOptions> = {},
) {
  const database = new StudyDatabase(file, { maxBytes, readOnly });
  const plans = new StudyPlans(database);
  const places = new StudyPlaces(database, plans);
  const commands = new StudyCommands(database, places);
  const records = new StudyRecords(database, plans, places, commands);
  const motion = new StudyMotion(database, places);
  const software = new StudySoftware(database);
  return {
    ...{ plans, places, records, motion, commands, software },
    deletion: new StudyDeletion({ database, plans, places, records, motion, commands }),
    overview(study: string, now: number): readonly ParticipantState[] {
      const { version: newest, versions } = plans.get(study);
      return places.all(study).map((row) => {
        const followed = versions.find(({ version }) => version === (row.plan_version ?? newest)) as PlanVersion;
        return stateOf(row, followed, records.count(study, row.participant), now);
      });
    },
    storedStudy: (study: string, version: number, participant?: string): StoredStudy =>
      database.snapshot(() => {
        const { plan, simulated, createdAt, retentionUntil, versions } = plans.get(study, version);
        const about = { simulated, retentionUntil, served: software.since(createdAt) };
        const all = { records: records.all(study, participant), motion: motion.all(study, participant) };
        if (participant !== undefined) return { ...about, ...all, plan: plans.planFor(study, participant) };
        const { participants } = versions.find((one) => one.version === version) as PlanVersion;
        const isFollower = (row: { readonly participant: string }) => participants.includes(row.participant);
        return {
          ...about,
          ...(versions.length > 1 && { planVersion: version }),
          plan,
          records: all.records.filter(isFollower),
          motion: all.motion.filter(isFollower),
        };
      }),
    flushed: () => database.flushed(),
    /** Overwrites deleted data that could not be overwritten at their deletion; returns false if that fails again. */
    purgeDeleted: () => !database.mustPurge || database.purgeDeleted(),
    close: () => database.close(),
  };
}
