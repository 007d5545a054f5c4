import { otherSide } from '../../core/math/side';
import type { ProgressEvent } from '../../core/study/advance';
import { PhrasedError } from '../../core/study/phrases/phrases';
import { placeOf } from '../../core/study/progress';
import { randomFor } from '../../core/study/shuffle';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import type { CalibrationStep } from '../../ui/calibration-dialog';
import { type CalibrationGuide, createCalibrationGuide } from '../../ui/calibration-guide';
import { Answering } from './answering';
import { ExchangeTimer } from './exchange-timer';
import type { ParticipantSession } from './participant-session';
import { RaisedHands } from './raised-hands';
import { reasonFor, refusalFor } from './reasons';
import { remoteFaults } from './remote-faults';
import type { StudyHost } from './study-host';
import type { StudyPage } from './study-page';
import { lockedOutScreen, screenOf } from './study-screens';
import type { ScreenActions } from './study-situation';
import {
  type FinishedTrial,
  isPlayed,
  lastPlayedBefore,
  type PlayedStep,
  type PlayedTrial,
  playTrial,
} from './study-trial';
import type { TaskPlace, TaskRunner } from './task-runner';
import { TrialPreparation } from './trial-preparation';

/** How often what is shown follows the clock [ms]. */
const tickEveryMs = 250;

export interface RunningStudyOptions {
  readonly host: StudyHost;
  readonly page: StudyPage;
  /** Removes everything of this participant from the device. */
  readonly forget: () => Promise<void>;
}

/** A participant's session under way: shows what it is at, plays its trials and keeps the server informed. */
export class RunningStudy {
  readonly session: ParticipantSession;
  readonly #host: StudyHost;
  readonly #page: StudyPage;
  readonly #forget: () => Promise<void>;
  readonly #exchanges: ExchangeTimer;
  readonly #preparation: TrialPreparation;
  readonly #guide: CalibrationGuide;
  readonly #actions: ScreenActions;
  #trial: PlayedTrial | null = null;
  readonly #answering: Answering;
  /** Why the last wish changed nothing; null: it did. */
  #refusal: string | null = null;
  /** What the last measuring found wrong. */
  #measuredFaults: readonly string[] = [];
  /** How high the eyes were last seen [m]; null: not yet. */
  #eyes: number | null = null;
  /** The participant wants to stop and has not confirmed it yet. */
  #stopping = false;
  readonly #raised = new RaisedHands();
  #shownStep = '';
  /** Whether this visit of the page has put a body on yet. */
  #embodied = false;
  /** null: no one is being measured. */
  #calibration: CalibrationStep | null = null;

  constructor(session: ParticipantSession, { host, page, forget }: RunningStudyOptions) {
    this.session = session;
    this.#host = host;
    this.#page = page;
    this.#forget = forget;
    this.#answering = new Answering(session);
    this.#exchanges = new ExchangeTimer(session, page.after);
    this.#preparation = new TrialPreparation(
      (step) => this.#load(step),
      () => this.show(),
    );
    this.#guide = createCalibrationGuide({
      onStep: (step) => {
        this.#calibration = step;
        this.show();
      },
      onMeasured: (calibration) => {
        // Calibration makes a standing person of one who sits: how high the eyes are now is what tells.
        const faults = remoteFaults(session, host, this.#eyes);
        this.#guide.cancel();
        this.#measuredFaults = faults;
        if (faults.length > 0) return;
        host.setCalibration(calibration);
        session.apply({ type: 'calibrated', calibration });
      },
      // What went wrong stays to be read until the participant measures again.
      closesItself: () => false,
    });
    this.#actions = {
      apply: (event) => this.#apply(event),
      goTo: (index) => {
        this.#answering.goTo(index);
        this.#said(null);
      },
      choose: (question, value) => this.#said(this.#answering.choose(question, value)),
      type: (question, typed) => this.#said(this.#answering.type(question, typed)),
      submit: () => {
        if (this.#answering.readyToSubmit()) this.#apply({ type: 'submit' });
        else this.#said(null);
      },
      calibrate: () => {
        this.#measuredFaults = [];
        this.#guide.start();
      },
      enterVr: () => void host.enterVr(),
      askToStop: (on) => {
        this.#stopping = on;
        this.show();
      },
      prepareAgain: () => {
        this.#preparation.forget();
        this.show();
      },
    };
  }

  /** Whether a trial is being played; one that still waits for others is not. */
  get playing(): boolean {
    return this.#trial !== null && this.#trial.waitingFor === null;
  }

  /** Whether the round on the page stands still. */
  get paused(): boolean {
    return this.session.progress.paused || (this.#trial !== null && !this.#host.inSession());
  }

  /** Shows the step at hand, now and as time passes, and begins to talk to the server. */
  begin(): void {
    const { calibration, preferredHand } = this.session;
    this.#host.setCalibration(calibration);
    // The bow goes into the hand that does not draw it.
    if (preferredHand) this.#host.setBowSide(otherSide(preferredHand));
    this.show();
    this.#tickLater();
    void this.exchange();
  }

  /** Tells the server what is new and follows what the experimenter wants; resolves when that is over. */
  exchange(): Promise<void> {
    return this.#exchanges.exchange();
  }

  /** Every frame drawn; null: the head was not seen. */
  frame(time: number, frame: TrackingFrame | null): void {
    if (frame) {
      this.#eyes = frame.head.position.y;
      this.#guide.observe(frame);
    }
    // No sheet hangs there while a round is played: this is how it is stopped.
    if (this.#raised.follow(this.playing ? frame : null)) this.#apply({ type: 'pause' });
    if (this.#trial?.interrupted) this.#apply({ type: 'reload' });
    const finished = this.#trial?.follow(time, frame);
    if (finished) this.#finishTrial(finished);
  }

  /** Records a round that is over, though its end is still being looked at: what comes now would make it void. */
  conclude(): void {
    const finished = this.#trial?.conclude();
    if (finished) this.#finishTrial(finished);
  }

  /** The headset was put on or taken off. */
  sessionChanged(): void {
    const worn = this.#host.inSession();
    if (!worn) this.conclude();
    const { running, paused } = this.session.progress;
    // A round is void when the headset comes off in the middle of it.
    if (!worn && running && !paused && this.#trial) this.#apply({ type: 'reload' });
    if (!worn) this.#guide.cancel();
    this.show();
  }

  /** Shows what the session is at now, however it came there. */
  show(): void {
    const { session } = this;
    const { phrases } = session;
    const { display } = this.#page;
    if (session.safekeeping.lockedOut) {
      this.#showLockedOut();
      return;
    }
    this.#settle();
    if (session.withdrawalCode !== null) {
      display.ask({
        kind: 'code',
        phrases,
        code: session.withdrawalCode,
        withdrawalPage: this.#page.address.withdrawalPage(),
        noted: () => session.codeNoted(),
        stop: () => {
          session.codeNoted();
          this.#apply({ type: 'stop', by: 'participant' });
        },
      });
    } else if (session.step.kind === 'demographics') {
      display.ask({
        kind: 'demographics',
        phrases,
        stop: () => this.#apply({ type: 'stop', by: 'participant' }),
        done: (answers) => this.#takeDemographics(answers),
      });
    } else {
      display.show(this.#screen(), this.#host.inSession());
    }
  }

  #screen() {
    return screenOf(
      {
        session: this.session,
        inSession: this.#host.inSession(),
        question: this.#answering.question,
        typed: this.#answering.typed,
        triedToSubmit: this.#answering.triedToSubmit,
        calibration: this.#calibration,
        withdrawalPage: this.#page.address.withdrawalPage(),
        setupFaults:
          this.#measuredFaults.length > 0 ? this.#measuredFaults : remoteFaults(this.session, this.#host, null),
        prepared: this.#preparation.of(this.#attempt()),
        refusal: this.#refusal,
        stopping: this.#stopping,
        playing: this.#trial !== null,
        waitingFor: this.#trial?.waitingFor ?? null,
        standing: this.#trial?.standing ?? false,
      },
      this.#actions,
    );
  }

  #showLockedOut(): void {
    this.#dropTrial();
    const { progress, plan, phrases, safekeeping } = this.session;
    const { participant } = progress;
    const contact = plan.remote?.contact ?? null;
    const reload = () => this.#page.address.reload();
    // A device whose storage fails gives nothing out either: the page begins as on another device.
    const anew = () => void this.#forget().then(reload, reload);
    this.#page.display.ask(
      { kind: 'locked-out', phrases, participant, unsent: safekeeping.unsent, contact, anew },
      this.#host.inSession() ? lockedOutScreen(this.session) : null,
    );
  }

  #tickLater(): void {
    this.#page.after(tickEveryMs, () => {
      this.#tickLater();
      if (this.session.step.kind === 'rest') this.session.apply({ type: 'tick' });
      this.show();
    });
  }

  /** What follows from where the session is now. */
  #settle(): void {
    const { step, progress, simulated } = this.session;
    if (step.id !== this.#shownStep) this.#enterStep();
    if (this.#trial && this.#trial.key !== this.#attempt()) this.#dropTrial();
    // With the headset off, a pause goes on until it is worn again.
    this.#trial?.pause(progress.paused || !this.#host.inSession());
    if (isPlayed(step)) this.#settleTrial(step);
    if (step.kind !== 'consent') this.#host.setActor(simulated);
  }

  #enterStep(): void {
    this.#shownStep = this.session.step.id;
    this.#refusal = null;
    this.#stopping = false;
    this.#measuredFaults = [];
    this.#guide.cancel();
    // The guide's last word on an earlier measuring may have come when its step was over.
    this.#calibration = null;
    this.#answering.enterStep();
    if (!this.#embodied) void this.#wearAgain();
  }

  /** Before a reload the participant wore the body of what was played last, and still does in the rest and the questions that follow. */
  async #wearAgain(): Promise<void> {
    const { step } = this.session;
    const played = isPlayed(step) ? undefined : lastPlayedBefore(this.session.schedule, step);
    if (!played) return;
    try {
      await this.#embody(played);
    } catch (error) {
      if (this.session.step !== step) return;
      this.#refusal = reasonFor(error, this.session.phrases);
      this.show();
    }
  }

  #embody(step: PlayedStep): Promise<void> {
    this.#embodied = true;
    return this.#host.embody(step.embodiment, this.#seedOf(step));
  }

  #settleTrial(step: PlayedStep): void {
    const attempt = this.#attempt();
    // Every attempt anew: a game that was put away when a trial became void is no longer there.
    if (!this.#preparation.of(attempt)) void this.#preparation.begin(attempt, step);
    const { running, paused } = this.session.progress;
    const ready = this.#preparation.of(attempt)?.state === 'ready';
    if (running && !paused && !this.#trial && ready && this.#host.inSession()) this.#startTrial(step);
  }

  /** Loads the game and the body of a step, before it can be started; rejects with a sentence for the participant. */
  async #load(step: PlayedStep): Promise<void> {
    try {
      const runner = this.#runnerOf(step);
      if (!runner) throw new PhrasedError('round.game');
      await Promise.all([runner.prepare(this.#placeFor(step)), this.#embody(step)]);
    } catch (error) {
      throw new Error(reasonFor(error, this.session.phrases));
    }
  }

  #runnerOf(step: PlayedStep): TaskRunner | null {
    const game = this.session.plan.tasks.find(({ id }) => id === step.task)?.game;
    return (game && this.#host.runners[game]) ?? null;
  }

  /** Where a group meets: a room of its own for every trial of every run, on a seat that the server signs. */
  #placeFor(step: PlayedStep): TaskPlace {
    const { session } = this;
    const run = session.progress.runs[`${step.task}/${step.block}`] ?? 1;
    return {
      seat: () => session.seat({ step: step.id, run }),
      participant: session.progress.participant,
      members: session.schedule.groups[step.task]?.members ?? [],
      seconds: step.seconds,
    };
  }

  /** Step, run and attempt at hand: when it changes under a trial, that trial is void. */
  #attempt(): string {
    const { schedule, progress, step } = this.session;
    const place = placeOf(schedule, progress);
    return `${step.id}@${place?.run}.${place?.attempt}`;
  }

  #startTrial(step: PlayedStep): void {
    const runner = this.#runnerOf(step);
    if (!runner) return;
    const { plan, progress } = this.session;
    const motion = progress.motion === true && plan.consent.motion !== null && step.kind === 'trial';
    const options = { key: this.#attempt(), motion, seed: this.#seedOf(step), now: this.#page.now };
    this.#trial = playTrial(step, runner, this.#host, options);
    this.show();
  }

  /** The same round for each participant's first, second … trial: what differs between conditions is not the layout. */
  #seedOf(step: PlayedStep): number {
    const repetition = step.kind === 'trial' ? step.repetition : 0;
    return randomFor(this.session.plan.seed, `layout of ${step.task} ${repetition}`).seed >>> 1;
  }

  #dropTrial(): void {
    this.#trial?.abort();
    this.#trial = null;
  }

  #finishTrial({ outcome, recording }: FinishedTrial): void {
    const { session } = this;
    const attempt = this.#attempt();
    this.#trial = null;
    const refusal = session.apply({ type: 'trial-finished', outcome });
    this.#refusal = refusalFor(refusal, session.phrases);
    if (recording !== null && refusal === null) session.keepMotion(`${attempt}:trial`, recording);
    void this.exchange();
  }

  #apply(event: ProgressEvent): void {
    this.conclude();
    this.#refusal = refusalFor(this.session.apply(event), this.session.phrases);
    void this.exchange();
    this.show();
  }

  /** Shows what came of a wish; null: all went well. */
  #said(refusal: string | null): void {
    this.#refusal = refusalFor(refusal, this.session.phrases);
    this.show();
  }

  /** Why the answers cannot be taken; null: they are. */
  #takeDemographics(answers: Record<string, unknown>): string | null {
    const complaint = this.session.apply({ type: 'demographics', demographics: answers });
    if (complaint === null) {
      void this.exchange();
      const { preferredHand } = this.session;
      if (preferredHand) this.#host.setBowSide(otherSide(preferredHand));
    }
    this.show();
    return refusalFor(complaint, this.session.phrases);
  }
}
