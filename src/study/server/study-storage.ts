import { gunzipSync } from 'node:zlib';
import type { Software } from 'threepoint-http';
import type { StudyPlan } from '../model/plan/plan';
import type { Progress } from '../model/progress/progress';
import type { NumberedCommand, ParticipantState, Receipt, StudyCommand, StudyInfo } from '../model/progress/study-api';
import type { RecordAuthor, StoredRecord, StudyRecord } from '../model/records/study-record';

/** A value, or a promise of it from a database that another process runs. */
export type Awaitable<T> = T | Promise<T>;

export interface AddOptions {
  readonly simulated: boolean;
  /** Seconds since 1970. */
  readonly at: number;
  /** Whether another plan becomes a new version for later participants if the study has begun. */
  readonly newVersion?: boolean;
}

export interface PlanStorage {
  /** Returns a study with this version of its plan or with the newest; throws a Rejection if it is unknown. */
  get(id: string, version?: number): Awaitable<StudyInfo>;
  /** Returns the plan that a participant follows: that of their beginning, or the newest. */
  planFor(id: string, participant: string): Awaitable<StudyPlan>;
  /** Returns all studies, the oldest first. */
  all(): Awaitable<readonly StudyInfo[]>;
  /**
   * Adds a study, or returns an equal one that exists. Another plan for a study that has begun is refused unless it is
   * added as a new version. Participants who have begun, and those who play with them, keep their version. Throws a
   * ValidationError for an invalid plan.
   */
  add(plan: unknown, options: AddOptions): Awaitable<StudyInfo>;
}

/** The places of a study's participants. Every call throws a Rejection for an unknown participant. */
export interface PlaceStorage {
  get(study: string, participant: string): Awaitable<object>;
  acceptsInvitation(study: string, participant: string, code: string): Awaitable<boolean>;
  renewInvitation(study: string, participant: string): Awaitable<void>;
  /** Takes a free place. The withdrawal code is new until something is recorded, and null later. */
  claim(
    study: string,
    participant: string,
    at: number,
  ): Awaitable<{ readonly token: string; readonly withdrawalCode: string | null }>;
  /** If nothing is recorded yet, the withdrawal code becomes void too, because its owner may never have received it. */
  release(study: string, participant: string): Awaitable<void>;
  /** Returns whether this is the token of the device that has taken the place; false for an unknown participant. */
  holds(study: string, participant: string, token: string): Awaitable<boolean>;
  /** Stores the progress of a participant unless a later report is stored; throws a Rejection before consent. */
  saveProgress(study: string, participant: string, progress: unknown, at: number): Awaitable<void>;
  /** Returns the progress as it was reported; with `now`, its clock has run on since the report. */
  progress(study: string, participant: string, now?: number): Awaitable<Progress | null>;
}

/** The records of participants who have consented. */
export interface RecordStorage {
  /** Stores the new ones of these records, or none; returns the ids of all. `at` is the time of their receipt. */
  store(
    study: string,
    participant: string,
    records: readonly StudyRecord[],
    at: number,
    author?: RecordAuthor,
  ): Awaitable<readonly string[]>;
  /** Stores a remark of the experimenter; returns its id. */
  addRemark(study: string, participant: string, text: string, at: number): Awaitable<string>;
  /** Returns the records of one participant, or of all. */
  all(study: string, participant?: string): Awaitable<readonly StoredRecord[]>;
  /** Returns the records of these participants as parts of a JSON list, because a whole study may fill the memory. */
  listed(study: string, participants: ReadonlySet<string>): Awaitable<readonly Uint8Array[]>;
}

/** A recording of tracking frames in the format of recording.ts. */
export interface MotionFile {
  readonly participant: string;
  /** The id of the trial's record. */
  readonly trial: string;
  readonly text: string;
}

/** A recording in its stored form. */
export interface PackedMotion extends Omit<MotionFile, 'text'> {
  readonly gzipped: Uint8Array;
}

export const unpacked = ({ participant, trial, gzipped }: PackedMotion): MotionFile => ({
  participant,
  trial,
  text: gunzipSync(gzipped).toString(),
});

/** The recordings of trials of participants who consented to them. */
export interface MotionStorage {
  store(study: string, participant: string, trial: string, text: string, at: number): Awaitable<void>;
  /** Returns the recordings of one participant, or of all. */
  all(study: string, participant?: string): Awaitable<readonly PackedMotion[]>;
}

/** The commands of experimenters to participants' pages. */
export interface CommandStorage {
  /** Returns the number of the command. */
  add(study: string, participant: string, command: StudyCommand, at: number): Awaitable<number>;
  /** Returns the commands with a higher number, in order. */
  after(study: string, participant: string, number: number): Awaitable<readonly NumberedCommand[]>;
}

/** Called with a participant who could not be deleted, and with the error. */
export type DeletionError = (place: { readonly study: string; readonly participant: string }, error: unknown) => void;

/** Deletes everything that is stored of a participant, and keeps a receipt. */
export interface DeletionStorage {
  delete(study: string, participant: string, reason: Receipt['reason'], at: number): Awaitable<Receipt>;
  /** Deletes a simulated study with its receipts; throws a Rejection for one of people. */
  deleteSimulated(study: string): Awaitable<void>;
  /** Deletes everything of the participant with this code; returns null if there is none. */
  withdraw(study: string, code: string, at: number): Awaitable<Receipt | null>;
  /** Deletes the recordings of the participant with this code, who has no more made; returns null if there is none. */
  withdrawMotion(study: string, code: string, at: number): Awaitable<Receipt | null>;
  /**
   * Deletes what is past its retention date, each participant separately; `onError` is called with each failed
   * deletion.
   */
  deleteExpired(now: number, onError: DeletionError): Awaitable<readonly Receipt[]>;
  receipts(study: string): Awaitable<readonly Receipt[]>;
}

/** Software and the time since which it served the studies, in seconds since 1970. */
export type ServedSoftware = Software & { readonly since: number };

/** The software with which a server has served its studies. */
export interface SoftwareStorage {
  /** Stores the software that serves from now on, if it has changed. */
  note(software: Software, at: number): Awaitable<void>;
  /** Returns the software that has served since this moment, the oldest first. */
  since(at: number): Awaitable<readonly ServedSoftware[]>;
}

/** What is stored of a study or of one participant, all from one state of the storage. */
export interface StoredStudy extends Pick<StudyInfo, 'simulated' | 'retentionUntil'> {
  /** The plan in the version of the study, or the one that the participant follows. */
  readonly plan: StudyPlan;
  /** The version of the study's plan, if that has several. */
  readonly planVersion?: number;
  /** The records and recordings of all participants who follow this version, or of the one participant. */
  readonly records: readonly StoredRecord[];
  readonly motion: readonly PackedMotion[];
  /** The software that has served the study since its creation. */
  readonly served: readonly ServedSoftware[];
}

/**
 * The studies and their records, for routes. Results are stored when a call returns and survive the end of the process.
 * They survive a power cut when `flushed` has resolved, and nothing is acknowledged before. Calls that change something
 * are made one after the other. A call throws a Rejection, "locked" only before it changes anything. Times are seconds
 * since 1970 of the caller's clock.
 */
export interface StudyStorage {
  readonly plans: PlanStorage;
  readonly places: PlaceStorage;
  readonly records: RecordStorage;
  readonly motion: MotionStorage;
  readonly commands: CommandStorage;
  readonly deletion: DeletionStorage;
  readonly software: SoftwareStorage;
  /** Returns what an export of a version of a study, or of one participant, contains. */
  storedStudy(study: string, version: number, participant?: string): Awaitable<StoredStudy>;
  /** Returns the state of every place at this time [s]. */
  overview(study: string, now: number): Awaitable<readonly ParticipantState[]>;
  /** Resolves when everything so far is on the disk; concurrent calls share a flush. */
  flushed(): Promise<void>;
}
