import type { StudyPlan } from '../plan/plan';
import type { ParticipantProfile } from '../records/participant-profile';
import type { StudyRecord } from '../records/study-record';
import type { Progress } from './progress';

/** A block of a task, from 1. */
export interface MeantBlock {
  readonly task: string;
  readonly block: number;
}

/** What an experimenter asks of a participant's page; `of`: the block that was under way when it was asked, absent: the present one. */
export type StudyCommand =
  | { readonly type: 'start' }
  | { readonly type: 'pause' }
  | { readonly type: 'resume' }
  | { readonly type: 'stop'; readonly by: 'experimenter'; readonly reason: string }
  | { readonly type: 'void-block'; readonly reason: string; readonly repeat: boolean; readonly of?: MeantBlock };

/** A recording of tracked frames that the server takes at once [bytes]. */
export const mostMotionBytes = 16 * 2 ** 20;

/** Proof that something was deleted; it holds nothing of what was. */
export interface Receipt {
  readonly number: number;
  readonly study: string;
  readonly participant: string;
  readonly reason: 'withdrawn' | 'experimenter' | 'retention';
  readonly records: number;
  readonly motionFiles: number;
  /** Seconds since 1970. */
  readonly at: number;
}

/** What the experimenter sees of a participant. */
export interface ParticipantState {
  readonly participant: string;
  /** Of the plan that this participant follows. */
  readonly version: number;
  /** What takes the place; null: the participant has withdrawn. */
  readonly invitation: string | null;
  readonly claimed: boolean;
  readonly withdrawn: boolean;
  readonly records: number;
  /** Where the session is; null: it has not begun. */
  readonly session: {
    readonly step: string;
    readonly kind: string;
    readonly running: boolean;
    readonly paused: boolean;
    /** Asked whether to stop, because of what was answered. */
    readonly unwell: boolean;
    /** Ended before its end. */
    readonly stopped: boolean;
    /** null: the step has no time limit. */
    readonly remainingSeconds: number | null;
    /** Since when the page has not reported, by the server's clock [s]: that of the experimenter's computer may be minutes off. */
    readonly silence: number;
  } | null;
}

/** A plan as it was for some of a study's participants: those who began with it stay with it. */
export interface PlanVersion {
  /** From 1. */
  readonly version: number;
  readonly plan: StudyPlan;
  /** Seconds since 1970. */
  readonly since: number;
  /** Who began with it, and who plays with them. */
  readonly participants: readonly string[];
}

export interface StudyInfo {
  readonly plan: StudyPlan;
  /** Of the plan. */
  readonly version: number;
  /** Every version, the oldest first. */
  readonly versions: readonly PlanVersion[];
  readonly simulated: boolean;
  readonly createdAt: number;
  readonly retentionUntil: number;
}

/** What is public of a study. */
export interface PublicStudy extends Pick<StudyPlan, 'id' | 'title' | 'consent'> {
  /** Those that participants may choose from. */
  readonly languages: readonly [string, ...string[]];
  /** What the page says in them, where the plan gives it. */
  readonly phrases: NonNullable<StudyPlan['phrases']>;
  readonly simulated: boolean;
  /** Whom participants ask who have no one beside them; null: an experimenter is there. */
  readonly contact: string | null;
}

/** A trial that a group plays together: a step of the schedule, and the how many-eth run of its block. */
export interface PlayedTogether {
  readonly step: string;
  readonly run: number;
}

/** A seat in the room of such a trial, signed for one participant. */
export interface SignedSeat {
  readonly room: string;
  readonly token: string;
}

/** What a device is given that takes a participant's place; of the wearer what an earlier device sent. */
export interface Claim extends ParticipantProfile {
  readonly token: string;
  /** With the first claim, and again while nothing was recorded; null later. */
  readonly withdrawalCode: string | null;
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  /** Where another device left off; null: at the beginning. */
  readonly progress: Progress | null;
}

/** A line of the list of studies. */
export interface StudyListing extends Pick<StudyPlan, 'id' | 'participants'> {
  /** In the study's first language. */
  readonly title: string;
  readonly simulated: boolean;
  readonly createdAt: number;
  readonly retentionUntil: number;
}

/** Everything recorded in a study. */
export interface RecordedStudy extends StudyInfo {
  readonly records: readonly StudyRecord[];
}

/** A command as it is stored: numbers rise. */
export interface NumberedCommand {
  readonly number: number;
  readonly at: number;
  readonly command: StudyCommand;
}
