import type { StudyPlan } from '../src/core/study/plan';
import { currentStep, type Progress, remainingSeconds, resumed, sinceReport } from '../src/core/study/progress';
import { scheduleFor } from '../src/core/study/schedule';
import type { ParticipantState, PlanVersion, Receipt, StudyCommand, StudyInfo } from '../src/core/study/study-api';
import type { StudyRecord } from '../src/core/study/study-record';
import type { Software } from './software';
import { type NumberedCommand, StudyCommands } from './study-commands';
import { StudyDatabase } from './study-database';
import { type DeletionFault, StudyDeletion } from './study-deletion';
import { type PackedMotion, StudyMotion } from './study-motion';
import { type PlaceRow, StudyPlaces } from './study-places';
import { type AddOptions, StudyPlans } from './study-plans';
import { StudyRecords } from './study-records';
import { type ServedSoftware, StudySoftware } from './study-software';

/**
 * Studies and what was recorded in them. What returns is stored and outlives the process; that it outlives a power cut too, `flushed` says,
 * and nothing is acknowledged before. Times are seconds since 1970, given by the caller.
 */
export interface StudyStore {
  /** Adds a study, or finds the same one there; refuses another plan under the id of a study that has begun, but as a new version. */
  addStudy(plan: StudyPlan, options: AddOptions): StudyInfo;
  /** Its plan in this version, else in the newest. */
  study(id: string, version?: number): StudyInfo;
  /** The plan that a participant follows. */
  planFor(study: string, participant: string): StudyPlan;
  studies(): readonly StudyInfo[];
  /** Whether this is the invitation to the place, however it was typed. */
  invites(study: string, participant: string, code: string): boolean;
  /** Another invitation to the place, in an open study to all of them; the old one opens nothing any more. */
  reinvite(study: string, participant: string): void;
  /** Gives a place that is free away. The withdrawal code comes with the first claim under which something is recorded; null later. */
  claim(
    study: string,
    participant: string,
    at: number,
  ): { readonly token: string; readonly withdrawalCode: string | null };
  /** Another device may claim the place; the old token is void, and so is the withdrawal code where nothing is recorded; what is stays. */
  release(study: string, participant: string): void;
  /** Whether this is the participant's token. */
  holds(study: string, participant: string, token: string): boolean;
  /** Stores what is not there yet, all or nothing; returns the ids of all. */
  storeRecords(study: string, participant: string, records: readonly StudyRecord[], at: number): readonly string[];
  records(study: string, participant?: string): readonly StudyRecord[];
  /** A remark of the experimenter, as a record of the participant. */
  addRemark(study: string, participant: string, text: string, at: number): string;
  saveProgress(study: string, participant: string, progress: unknown, at: number): void;
  /** As it was reported; `now`: with what its clock ran since. */
  progress(study: string, participant: string, now?: number): Progress | null;
  /** Returns the command's number. */
  addCommand(study: string, participant: string, command: StudyCommand, at: number): number;
  /** Commands after this number, oldest first. */
  commands(study: string, participant: string, after: number): readonly NumberedCommand[];
  /** Keeps the tracked frames of a trial; refuses without consent to that. */
  storeMotion(study: string, participant: string, trial: string, text: string, at: number): void;
  /** Recordings as they are stored. */
  motion(study: string, participant?: string): readonly PackedMotion[];
  /** This software serves the studies from now on. */
  noteSoftware(software: Software, at: number): void;
  /** What has served the studies since this moment, the oldest first. */
  softwareSince(at: number): readonly ServedSoftware[];
  overview(study: string, now: number): readonly ParticipantState[];
  deleteParticipant(study: string, participant: string, reason: Receipt['reason'], at: number): Receipt;
  /** Deletes a simulated study whole; refuses one of people. */
  deleteSimulated(study: string): void;
  /** Deletes everything of the participant who has this code; null: none has. */
  withdraw(study: string, code: string, at: number): Receipt | null;
  /** Deletes what is past its retention date; one participant of whom that fails (`onFault`) keeps no other one here. */
  deleteExpired(now: number, onFault: DeletionFault): readonly Receipt[];
  receipts(study: string): readonly Receipt[];
  /** Resolves when everything until now is on the disk; those who ask while the disk is at work wait for one flush together. */
  flushed(): Promise<void>;
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

/**
 * Opens the database in this file, makes it where there is none, and brings it up to date. It grows to `mostBytes`, so that studies leave
 * room for the rest of the machine; beyond that writes are refused as "full".
 */
export function openStudyStore(file: string, { mostBytes = 16 * 2 ** 30 } = {}): StudyStore {
  const database = new StudyDatabase(file, mostBytes);
  const plans = new StudyPlans(database);
  const places = new StudyPlaces(database, plans);
  const records = new StudyRecords(database, plans, places);
  const motion = new StudyMotion(database, places);
  const commands = new StudyCommands(database, places);
  const software = new StudySoftware(database);
  const deletion = new StudyDeletion({ database, plans, places, records, motion, commands });
  return {
    addStudy: (plan, options) => plans.add(plan, options),
    study: (id, version) => plans.get(id, version),
    planFor: (study, participant) => plans.planFor(study, participant),
    studies: () => plans.all(),
    invites: (study, participant, code) => places.invites(study, participant, code),
    reinvite: (study, participant) => places.reinvite(study, participant),
    claim: (study, participant, at) => places.claim(study, participant, at),
    release: (study, participant) => places.release(study, participant),
    holds: (study, participant, token) => places.holds(study, participant, token),
    storeRecords: (study, participant, sent, at) => records.store(study, participant, sent, at),
    records: (study, participant) => records.all(study, participant),
    addRemark: (study, participant, text, at) => records.addRemark(study, participant, text, at),
    saveProgress: (study, participant, progress, at) => places.saveProgress(study, participant, progress, at),
    progress: (study, participant, now) => places.progress(study, participant, now),
    addCommand: (study, participant, command, at) => commands.add(study, participant, command, at),
    commands: (study, participant, after) => commands.after(study, participant, after),
    storeMotion: (study, participant, trial, text, at) => motion.store(study, participant, trial, text, at),
    motion: (study, participant) => motion.all(study, participant),
    noteSoftware: (used, at) => software.note(used, at),
    softwareSince: (at) => software.since(at),
    overview(study, now) {
      const { version: newest, versions } = plans.get(study);
      return places.all(study).map((row) => {
        const followed = versions.find(({ version }) => version === (row.plan_version ?? newest)) as PlanVersion;
        return stateOf(row, followed, records.count(study, row.participant), now);
      });
    },
    deleteParticipant: (study, participant, reason, at) => deletion.delete(study, participant, reason, at),
    deleteSimulated: (study) => deletion.deleteSimulated(study),
    withdraw: (study, code, at) => deletion.withdraw(study, code, at),
    deleteExpired: (now, onFault) => deletion.deleteExpired(now, onFault),
    receipts: (study) => deletion.receipts(study),
    flushed: () => database.flushed(),
    close: () => database.close(),
  };
}
