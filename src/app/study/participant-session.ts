import type { Calibration } from '../../core/body/calibration';
import { reasonOf } from '../../core/errors/reasons';
import type { Side } from '../../core/math/side';
import { type Schedule, type StudyStep, scheduleFor } from '../../core/study/plan';
import {
  advance,
  begin,
  currentStep,
  type Progress,
  type ProgressEvent,
  remainingSeconds,
} from '../../core/study/progress';
import type { Claim, NumberedCommand, PlayedTogether, SignedSeat } from '../../core/study/study-api';
import type { StudyRecord } from '../../core/study/study-record';
import { type ParticipantClient, ServerRefusal, ServerUnreachable } from '../../net/study-client';
import type { KeptMotion, KeptSession, StudyVault } from './study-vault';

/** Where what was recorded is now. */
export interface Safekeeping {
  /** Records and recordings that the server has not acknowledged. */
  readonly unsent: number;
  /** Of these, how many are in the memory of the page alone, because the device has no room. */
  readonly unsaved: number;
  /** Why the device could not store; null: it can. */
  readonly storageFault: string | null;
  /** Whether the server answered last time. */
  readonly online: boolean;
  /** What the server will not take, however often it is sent; null: nothing. */
  readonly refusal: string | null;
  /** The place is no longer this device's: the experimenter released it or deleted what was recorded. */
  readonly lockedOut: boolean;
}

/** One participant on this device: the steps, and the way of every record from here to the server. */
export interface ParticipantSession {
  readonly schedule: Schedule;
  readonly progress: Progress;
  readonly step: StudyStep;
  readonly plan: KeptSession['plan'];
  readonly simulated: boolean;
  /** null once it has been noted. */
  readonly withdrawalCode: string | null;
  readonly preferredHand: Side | null;
  /** The newest measures of the body; null: not measured yet. */
  readonly calibration: Calibration | null;
  readonly safekeeping: Safekeeping;
  /** Seconds left of this step; null: it has no limit. */
  remaining(): number | null;
  /** Takes an event at once and stores what follows; returns why not, null: taken. */
  apply(event: ProgressEvent): string | null;
  codeNoted(): void;
  /** The participant's seat in the room of a trial that the group plays together; rejects with why there is none. */
  seat(trial: PlayedTogether): Promise<SignedSeat>;
  /** Tracked frames of a trial, kept until the server has them. */
  keepMotion(trial: string, recording: string): void;
  /** Sends what is unsent, reports the progress and follows the experimenter's commands. Never rejects. */
  exchange(): Promise<void>;
  /** Resolves when the device has stored everything so far, or has said that it cannot. */
  settled(): Promise<void>;
}

export interface ParticipantSessionOptions {
  readonly client: ParticipantClient;
  /** null: this browser stores nothing; records stay in memory until they are sent. */
  readonly vault: StudyVault | null;
  /** Seconds since 1970. */
  readonly now: () => number;
  readonly onChange: () => void;
}

/** Bodies of the server are 512 KiB at most; a batch stays well below [characters, records]. */
const longestBatch = 300_000;
const largestBatch = 100;

/** The first session of a participant on this device. */
export function startSession(claim: Claim, study: string, participant: string): KeptSession {
  const schedule = scheduleFor(claim.plan, participant);
  return {
    study,
    participant,
    token: claim.token,
    withdrawalCode: claim.withdrawalCode,
    plan: claim.plan,
    simulated: claim.simulated,
    progress: claim.progress ?? begin(schedule, claim.simulated),
    commandsSeen: 0,
    preferredHand: null,
    calibration: null,
  };
}

/**
 * Whether the server knows a later state of a session than this device: a device whose storage was full when the page went tells
 * an old story. Blocks that run again count first, then the step, then its attempt.
 */
export function isLater(schedule: Schedule, known: Progress, here: Progress): boolean {
  const order = ({ runs, step, attempt }: Progress) => [
    Object.values(runs).reduce((sum, run) => sum + run, 0),
    schedule.steps.findIndex(({ id }) => id === step),
    attempt,
  ];
  const [there, local] = [order(known), order(here)];
  const differing = there.findIndex((value, index) => value !== local[index]);
  return differing >= 0 && (there[differing] as number) > (local[differing] as number);
}

/** `unsent`: what an earlier visit of this page left in the vault. */
export function createParticipantSession(
  kept: KeptSession,
  unsent: { readonly records: readonly StudyRecord[]; readonly motion: readonly KeptMotion[] },
  { client, vault, now, onChange }: ParticipantSessionOptions,
): ParticipantSession {
  const { study, participant, token } = kept;
  const schedule = scheduleFor(kept.plan, participant);
  let session = kept;
  const outbox = new Map(unsent.records.map((record) => [record.id, record]));
  const motionOutbox = new Map(unsent.motion.map((motion) => [motion.trial, motion]));
  /** Not in the vault yet. */
  let unsaved: readonly StudyRecord[] = [];
  const unsavedMotion = new Map<string, KeptMotion>();
  let storageFault: string | null = vault ? null : 'this browser offers no storage';
  let online = true;
  let refusal: string | null = null;
  let lockedOut = false;
  let saving: Promise<void> = Promise.resolve();
  let saved: KeptSession | null = kept;
  let reported: Progress | null = null;
  let exchanging: Promise<void> | null = null;

  /** One attempt after another; what fails stays unsaved and is tried again with the next. */
  function save(): void {
    saving = saving.then(async () => {
      if (!vault || (unsaved.length === 0 && unsavedMotion.size === 0 && saved === session)) return;
      const records = unsaved;
      const current = session;
      try {
        await vault.save(current, records);
        unsaved = unsaved.filter((record) => !records.includes(record));
        saved = current;
        for (const motion of [...unsavedMotion.values()]) {
          await vault.saveMotion(study, participant, motion);
          unsavedMotion.delete(motion.trial);
        }
        storageFault = null;
      } catch (error) {
        storageFault = reasonOf(error);
      }
      onChange();
    });
  }

  function change(next: KeptSession, records: readonly StudyRecord[]): void {
    session = next;
    for (const record of records) outbox.set(record.id, record);
    unsaved = [...unsaved, ...records];
    save();
    onChange();
  }

  function apply(event: ProgressEvent, commandsSeen = session.commandsSeen): string | null {
    const { progress, records, refusal: no } = advance(schedule, session.progress, event, now());
    if (no !== null && commandsSeen === session.commandsSeen) return no;
    if (progress === session.progress && records.length === 0 && commandsSeen === session.commandsSeen) return null;
    const demographics = records.find((record) => record.kind === 'demographics');
    const hand = demographics?.body.handedness;
    change(
      {
        ...session,
        progress,
        commandsSeen,
        ...(hand && { preferredHand: hand === 'left' ? 'left' : 'right' }),
        ...(event.type === 'calibrated' && { calibration: event.calibration }),
      },
      records,
    );
    return no;
  }

  function nextBatch(left: ReadonlySet<string>): readonly StudyRecord[] {
    const batch: StudyRecord[] = [];
    let length = 0;
    for (const record of outbox.values()) {
      if (left.has(record.id)) continue;
      length += JSON.stringify(record).length;
      if (batch.length > 0 && (length > longestBatch || batch.length >= largestBatch)) break;
      batch.push(record);
    }
    return batch;
  }

  async function acknowledge(ids: readonly string[]): Promise<void> {
    for (const id of ids) outbox.delete(id);
    unsaved = unsaved.filter(({ id }) => !ids.includes(id));
    // Whatever the save under way still writes must be removed after it.
    await saving;
    await vault?.removeRecords(study, participant, ids);
  }

  /** What the server will not take stays in the outbox and is reported; it does not hold up the rest. */
  async function sendRecords(): Promise<void> {
    const refused = new Set<string>();
    let reason: string | null = null;
    for (let batch = nextBatch(refused); batch.length > 0; batch = nextBatch(refused)) {
      let parts: readonly (readonly StudyRecord[])[] = [batch];
      while (parts.length > 0) {
        const [part = [], ...others] = parts;
        parts = others;
        try {
          await acknowledge(await client.send(study, participant, token, part));
          onChange();
        } catch (error) {
          if (!(error instanceof ServerRefusal) || error.status === 401) throw error;
          if (part.length > 1) parts = part.map((record) => [record]);
          else {
            for (const { id } of part) refused.add(id);
            reason = error.message;
          }
        }
      }
    }
    refusal = reason;
  }

  async function sendAll(): Promise<void> {
    await sendRecords();
    for (const { trial, recording } of [...motionOutbox.values()]) {
      await client.sendMotion(study, participant, token, trial, recording);
      motionOutbox.delete(trial);
      unsavedMotion.delete(trial);
      await saving;
      await vault?.removeMotion(study, participant, trial);
      onChange();
    }
  }

  /** Commands after the session's own state: each is followed once, even across a reload. */
  function follow({ number, command }: NumberedCommand): void {
    if (number <= session.commandsSeen) return;
    const { step, running } = session.progress;
    const event: ProgressEvent = command.type === 'start' ? { type: 'start' } : command;
    const no = apply(event, number);
    // The experimenter learns from the records why a command changed nothing.
    if (no !== null && session.progress.motion !== null) {
      apply({
        type: 'remark',
        text: `The command "${command.type}" changed nothing at ${step}${running ? ', running' : ''}: ${no}`,
      });
    }
  }

  async function exchangeOnce(): Promise<void> {
    save();
    // The server must not be ahead of the device: after a crash the device would tell it all again, and differently.
    await saving;
    try {
      await sendAll();
      // Before consent not even the step is reported.
      if (session.progress.motion !== null) {
        const { progress } = session;
        await client.saveProgress(study, participant, token, progress);
        reported = progress;
      }
      for (const command of await client.commands(study, participant, token, session.commandsSeen)) follow(command);
      // What a command changed is reported at once: the experimenter waits for it.
      if (session.progress !== reported && session.progress.motion !== null) {
        await sendAll();
        await client.saveProgress(study, participant, token, session.progress);
        reported = session.progress;
      }
      online = true;
    } catch (error) {
      if (error instanceof ServerUnreachable) online = false;
      else if (error instanceof ServerRefusal) {
        refusal = error.message;
        lockedOut = error.status === 401;
      } else storageFault = reasonOf(error);
    }
    onChange();
  }

  return {
    schedule,
    plan: kept.plan,
    simulated: kept.simulated,
    get progress() {
      return session.progress;
    },
    get step() {
      return currentStep(schedule, session.progress);
    },
    get withdrawalCode() {
      return session.withdrawalCode;
    },
    get preferredHand() {
      return session.preferredHand;
    },
    get calibration() {
      return session.calibration;
    },
    get safekeeping() {
      const memoryAlone = vault ? unsaved.length + unsavedMotion.size : outbox.size + motionOutbox.size;
      return {
        unsent: outbox.size + motionOutbox.size,
        unsaved: memoryAlone,
        storageFault,
        online,
        refusal,
        lockedOut,
      };
    },
    remaining: () => remainingSeconds(schedule, session.progress, now()),
    apply: (event) => apply(event),
    codeNoted() {
      change({ ...session, withdrawalCode: null }, []);
    },
    seat: (trial) => client.seat(study, participant, token, trial),
    keepMotion(trial, recording) {
      const motion = { trial, recording };
      motionOutbox.set(trial, motion);
      unsavedMotion.set(trial, motion);
      save();
      onChange();
    },
    exchange() {
      exchanging ??= exchangeOnce().finally(() => {
        exchanging = null;
      });
      return exchanging;
    },
    settled: () => saving,
  };
}
