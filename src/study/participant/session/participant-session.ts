import { type ParticipantClient, ServerUnreachable, type StudyPlace } from '../../client/study-client';
import { type Phrases, phrasesOf } from '../../model/phrases/phrases';
import { languagesOf } from '../../model/plan/plan';
import { type Schedule, scheduleFor } from '../../model/plan/schedule';
import { applyEvent, type ProgressEvent } from '../../model/progress/apply-event';
import { begin, currentStep, type Progress, remainingSeconds, reported } from '../../model/progress/progress';
import { Rejection } from '../../model/progress/rejection';
import type { Claim, NumberedCommand, PlayedTogether, SignedSeat } from '../../model/progress/study-api';
import { preferredHandOf } from '../../model/records/participant-profile';
import { MotionSender } from './motion-sender';
import { sendRecords } from './send-records';
import { SessionStore, type Unsent } from './session-store';
import type { KeptSession, StudyVault } from './study-vault';

/** How much of the recorded data the server has. */
export interface UploadStatus {
  /** The number of records and recordings that the server has not acknowledged. */
  readonly unsent: number;
  /** The number of these that are only in the memory of the page, because the device could not store them. */
  readonly unsaved: number;
  /** Why the device could not store them; null: it could. */
  readonly storageFault: string | null;
  /** Whether the server answered the last request. */
  readonly online: boolean;
  /** Why the server permanently refuses data; null: it refuses none. */
  readonly rejection: string | null;
  /** Whether the place belongs to another device, because the experimenter released it or deleted its records. */
  readonly lockedOut: boolean;
}

export interface ParticipantSessionOptions {
  readonly client: ParticipantClient;
  /** null: the browser stores nothing; records are kept in memory until they are sent. */
  readonly vault: StudyVault | null;
  /** Seconds since 1970. */
  readonly now: () => number;
  readonly onChange: () => void;
  /** Called before a command of the experimenter is followed, so that earlier results are recorded first. */
  readonly onCommand?: () => void;
}

/** Returns the first session of a participant on this device; another device may have begun it. */
export const startSession = (claim: Claim, place: StudyPlace): KeptSession => ({
  ...claim,
  ...place,
  progress: claim.progress ?? begin(scheduleFor(claim.plan, place.participant), claim.simulated),
});

/** The session of one participant on this device: its steps and the upload of its records. */
export class ParticipantSession {
  readonly schedule: Schedule;
  readonly #client: ParticipantClient;
  readonly #store: SessionStore;
  readonly #motion: MotionSender;
  readonly #now: () => number;
  readonly #onChange: () => void;
  readonly #onCommand: () => void;
  #online = true;
  #rejection: string | null = null;
  #lockedOut = false;
  /** The progress that was last reported to the server; null: none. */
  #reported: Progress | null = null;
  #exchanging: Promise<void> | null = null;
  #phrases: Phrases | null = null;

  constructor(kept: KeptSession, unsent: Unsent, options: ParticipantSessionOptions) {
    const { client, vault, now, onChange, onCommand = () => undefined } = options;
    this.schedule = scheduleFor(kept.plan, kept.participant);
    this.#client = client;
    this.#store = new SessionStore(kept, unsent, { vault, onChange });
    this.#motion = new MotionSender(this.#store, {
      send: (trial, recording) => client.sendMotion(kept, trial, recording),
      onError: (error) => this.#noteProblem(error),
      onChange,
    });
    this.#now = now;
    this.#onChange = onChange;
    this.#onCommand = onCommand;
  }

  get kept(): KeptSession {
    return this.#store.session;
  }

  get plan() {
    return this.kept.plan;
  }

  get phrases(): Phrases {
    const language = this.progress.language ?? languagesOf(this.plan)[0];
    if (this.#phrases?.language !== language) this.#phrases = phrasesOf(this.plan, language);
    return this.#phrases;
  }

  get simulated() {
    return this.kept.simulated;
  }

  get progress() {
    return this.kept.progress;
  }

  get step() {
    return currentStep(this.schedule, this.progress);
  }

  get uploadStatus(): UploadStatus {
    const { unsent, unsaved, problem } = this.#store;
    return {
      unsent,
      unsaved,
      storageFault: problem,
      online: this.#online,
      rejection: this.#rejection ?? this.#motion.rejection,
      lockedOut: this.#lockedOut,
    };
  }

  /** Returns the seconds left of this step, or null if it has no limit. */
  remaining(): number | null {
    return remainingSeconds(this.schedule, this.progress, this.#now());
  }

  /**
   * Applies an event and stores its consequences; returns why it is refused, or null. `command` is the number of the
   * experimenter's command that caused the event, which counts as followed even if nothing changes.
   */
  apply(event: ProgressEvent, command?: number): Rejection | null {
    const { kept } = this;
    const before = command === undefined ? kept.progress : { ...kept.progress, commandsSeen: command };
    const { progress, records, rejection } = applyEvent(this.schedule, before, event, this.#now());
    if (progress === kept.progress && records.length === 0) return rejection;
    const demographics = records.find((record) => record.kind === 'demographics')?.body;
    const next = {
      ...kept,
      progress,
      ...(demographics && { preferredHand: preferredHandOf(demographics) }),
      ...(event.type === 'calibrated' && { calibration: event.calibration }),
    };
    this.#store.change(next, records);
    return rejection;
  }

  /** Removes the withdrawal code from the device, once the participant has noted it. */
  codeNoted(): void {
    this.#store.change({ ...this.kept, withdrawalCode: null });
  }

  /**
   * Resolves with the participant's seat in the room of a trial that the group plays together; rejects with the reason
   * if there is none.
   */
  seat(trial: PlayedTogether): Promise<SignedSeat> {
    return this.#client.seat(this.kept, trial);
  }

  /** Keeps the tracking frames of a trial until the server has them. */
  keepMotion(trial: string, recording: string): void {
    this.#store.keepMotion({ trial, recording });
  }

  /**
   * Sends the unsent records, reports the progress and follows the experimenter's commands, then starts to upload
   * recordings without waiting for them. Never rejects.
   */
  exchange(): Promise<void> {
    this.#exchanging ??= this.#exchangeOnce().finally(() => {
      this.#exchanging = null;
    });
    return this.#exchanging;
  }

  /** Resolves when no upload of a recording is under way. Failed uploads are repeated with a later exchange. */
  motionSent(): Promise<void> {
    return this.#motion.sent();
  }

  /** Resolves when the device has stored everything so far or has reported that it cannot. */
  settled(): Promise<void> {
    return this.#store.settled();
  }

  async #exchangeOnce(): Promise<void> {
    // The server must not be ahead of the device: after a crash the device would send other records for the same
    // events.
    await this.#store.save();
    try {
      await this.#report();
      const commands = await this.#client.commands(this.kept, this.progress.commandsSeen);
      for (const command of commands) this.#follow(command);
      // The changes of a command are reported at once, because the experimenter waits for them.
      if (this.progress !== this.#reported) await this.#report();
      this.#online = true;
      this.#motion.send();
    } catch (error) {
      this.#noteProblem(error);
    }
    this.#onChange();
  }

  /** Sends the unsent records and then the progress, which is not reported before consent. */
  async #report(): Promise<void> {
    const { kept } = this;
    this.#rejection = await sendRecords(this.#store, (records) => this.#client.send(kept, records));
    const { progress } = this;
    if (progress.motion === null) return;
    await this.#client.saveProgress(kept, reported(progress, this.#now()));
    this.#reported = progress;
  }

  #noteProblem(error: unknown): void {
    if (error instanceof ServerUnreachable) this.#online = false;
    else if (error instanceof Rejection) {
      this.#rejection = error.message;
      this.#lockedOut = error.reason === 'unauthorised';
    } else this.#store.noteProblem(error);
  }

  /** Follows each command once, even across a reload or on another device. */
  #follow({ number, command }: NumberedCommand): void {
    if (number <= this.progress.commandsSeen) return;
    this.#onCommand();
    const { step, running, motion } = this.progress;
    const isPause = command.type === 'pause' || command.type === 'resume';
    const rejection = this.apply(isPause ? { ...command, by: 'experimenter' } : command, number);
    if (command.type === 'withdraw-motion') void this.#store.discardMotion();
    // A record states why a command changed nothing.
    if (rejection === null || motion === null) return;
    const why = `${step}${running ? ', running' : ''}: ${rejection.message}`;
    this.apply({ type: 'remark', text: `The command "${command.type}" changed nothing at ${why}` });
  }
}
