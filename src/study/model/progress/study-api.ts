import { identifier, integerBetween, text } from 'threepoint/core';
import * as v from 'valibot';
import type { StudyPlan } from '../plan/plan';
import type { ParticipantProfile } from '../records/participant-profile';
import type { StoredRecord } from '../records/study-record';
import type { Progress } from './progress';

const blockSchema = v.strictObject({ task: identifier, block: integerBetween(1, 1000) });

/** A block of a task, from 1. */
export type TargetBlock = v.InferOutput<typeof blockSchema>;

export const commandSchema = v.variant('type', [
  v.strictObject({ type: v.literal('start') }),
  v.strictObject({ type: v.literal('pause') }),
  v.strictObject({ type: v.literal('resume') }),
  v.strictObject({ type: v.literal('stop'), by: v.literal('experimenter'), reason: text(500) }),
  v.strictObject({
    type: v.literal('void-block'),
    reason: text(500),
    repeat: v.boolean('expected true or false'),
    /** The block that was under way when the command was given; absent: the present one. */
    of: v.exactOptional(blockSchema),
  }),
]);

/** A command to a participant's page: of the experimenter, or of the server, after a withdrawn consent to motion. */
export type StudyCommand = v.InferOutput<typeof commandSchema> | { readonly type: 'withdraw-motion' };

/** The largest recording that the server accepts [bytes]. */
export const maxMotionBytes = 16 * 2 ** 20;

/** The receipt of a deletion, without any deleted data. */
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

export interface ParticipantState {
  readonly participant: string;
  /** The version of the plan that this participant follows. */
  readonly version: number;
  /** The invitation to the place; null: the participant has withdrawn. */
  readonly invitation: string | null;
  readonly claimed: boolean;
  readonly withdrawn: boolean;
  readonly records: number;
  /** The state of the session; null: it has not begun. */
  readonly session: {
    readonly step: string;
    readonly kind: string;
    readonly running: boolean;
    readonly paused: boolean;
    /** Whether the participant is asked, because of answers, whether to stop. */
    readonly unwell: boolean;
    /** Whether a started trial waits for others, or its match stands. */
    readonly waiting: boolean;
    /** Whether the session was ended before its end. */
    readonly stopped: boolean;
    /** null: the step has no time limit. */
    readonly remainingSeconds: number | null;
    /**
     * The time since the page last reported, by the server's clock [s], because that of the experimenter's computer may
     * be wrong by minutes.
     */
    readonly silence: number;
  } | null;
}

/** A version of a plan; participants who began with it keep it. */
export interface PlanVersion {
  /** Counted from 1. */
  readonly version: number;
  readonly plan: StudyPlan;
  /** Seconds since 1970. */
  readonly since: number;
  /** The participants who began with it, and those who play with them. */
  readonly participants: readonly string[];
}

export interface StudyInfo {
  readonly plan: StudyPlan;
  readonly version: number;
  /** All versions, the oldest first. */
  readonly versions: readonly PlanVersion[];
  readonly simulated: boolean;
  readonly createdAt: number;
  readonly retentionUntil: number;
}

export interface PublicStudy extends Pick<StudyPlan, 'id' | 'title' | 'consent'> {
  /** The languages that participants may choose. */
  readonly languages: readonly [string, ...string[]];
  /** The phrases of the plan in these languages. */
  readonly phrases: NonNullable<StudyPlan['phrases']>;
  readonly simulated: boolean;
  /** The contact for participants who take part alone; null: an experimenter is present. */
  readonly contact: string | null;
}

export const playedTogetherSchema = v.strictObject({ step: text(120), run: integerBetween(1, 99) });

/** A trial that a group plays together: a step of the schedule and the run of its block. */
export type PlayedTogether = v.InferOutput<typeof playedTogetherSchema>;

/** A seat in the room of such a trial, signed for one participant. */
export interface SignedSeat {
  readonly room: string;
  readonly token: string;
}

/** The data for a device that takes a participant's place, with the profile from an earlier device. */
export interface Claim extends ParticipantProfile {
  readonly token: string;
  /** The withdrawal code, given with the first claim and again while nothing is recorded; null later. */
  readonly withdrawalCode: string | null;
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  /** The progress on an earlier device; null: none. */
  readonly progress: Progress | null;
}

export interface StudyListing extends Pick<StudyPlan, 'id' | 'participants'> {
  /** The title in the study's first language. */
  readonly title: string;
  readonly simulated: boolean;
  readonly createdAt: number;
  readonly retentionUntil: number;
}

export interface RecordedStudy extends StudyInfo {
  readonly records: readonly StoredRecord[];
}

/** A stored command; numbers increase. */
export interface NumberedCommand {
  readonly number: number;
  readonly at: number;
  readonly command: StudyCommand;
}
