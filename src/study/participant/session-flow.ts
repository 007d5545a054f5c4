import type { TrackingFrame } from 'threepoint/core';
import { otherSide } from 'threepoint/math';
import type { ProgressEvent } from '../model/progress/apply-event';
import type { Rejection } from '../model/progress/rejection';
import { BodyMeasurement } from './body-measurement';
import { ExchangeTimer } from './exchange-timer';
import type { StudyForm } from './forms/study-form';
import { InertSheet } from './inert-sheet';
import { localizedReason } from './localized-reasons';
import { PauseGesture } from './pause-gesture';
import { QuestionnaireState } from './questionnaire-state';
import { lockedOutScreen, screenOf } from './screens/study-screens';
import type { ScreenActions } from './screens/study-situation';
import type { ParticipantSession } from './session/participant-session';
import type { StudyPage } from './study-page';
import { SessionTrials } from './trial/session-trials';
import type { StudyHost } from './trial/study-host';
import type { FinishedTrial } from './trial/study-trial';

/** The interval at which the screen follows the clock [ms]. */
const tickEveryMs = 250;

interface SessionFlowOptions {
  readonly host: StudyHost;
  readonly page: StudyPage;
  /** Removes everything of this participant from the device. */
  readonly forget: () => Promise<void>;
}

/**
 * The flow of a participant's session: shows the present step, passes on the participant's actions and exchanges with
 * the server.
 */
export class SessionFlow {
  readonly session: ParticipantSession;
  readonly #host: StudyHost;
  readonly #page: StudyPage;
  readonly #forget: () => Promise<void>;
  readonly #exchanges: ExchangeTimer;
  readonly #measurement: BodyMeasurement;
  readonly #trials: SessionTrials;
  readonly #questionnaire: QuestionnaireState;
  readonly #actions: ScreenActions;
  readonly #pauseGesture = new PauseGesture();
  /** Why the last action changed nothing; null: it did. */
  #rejection: string | null = null;
  /** Whether the participant wants to stop and has not confirmed it yet. */
  #stopping = false;
  #shownStep = '';
  readonly #inertSheet: InertSheet;

  constructor(session: ParticipantSession, { host, page, forget }: SessionFlowOptions) {
    this.session = session;
    this.#host = host;
    this.#page = page;
    this.#forget = forget;
    const onChange = () => this.show();
    this.#questionnaire = new QuestionnaireState(session);
    this.#exchanges = new ExchangeTimer(session, page.after);
    this.#measurement = new BodyMeasurement(session, host, onChange);
    this.#trials = new SessionTrials({ session, host, now: page.now, onChange });
    this.#inertSheet = new InertSheet(page.now);
    this.#actions = this.#screenActions();
  }

  /** Whether a trial is being played; one that still waits for others is not. */
  get playing(): boolean {
    const { current } = this.#trials;
    return current !== null && current.runner.waitingFor === null;
  }

  /** Whether the round on the page is paused. */
  get paused(): boolean {
    return this.session.progress.paused || (this.#trials.current !== null && !this.#host.inSession());
  }

  /** Shows the present step from now on and starts to exchange with the server. */
  begin(): void {
    this.#host.setCalibration(this.session.kept.calibration);
    this.#setBowSide();
    this.show();
    this.#tickLater();
    void this.exchange();
  }

  /** Sends what is new to the server and follows the experimenter's commands; resolves when that is over. */
  exchange(): Promise<void> {
    return this.#exchanges.exchange();
  }

  /** Takes a drawn frame into account; null: the head was not seen. */
  frame(time: number, frame: TrackingFrame | null): void {
    if (frame) this.#measurement.observe(frame);
    // No sheet is shown while a round is played, so raised hands pause it.
    if (this.#pauseGesture.update(this.playing ? frame : null)) this.#apply({ type: 'pause' });
    this.#followMatch();
    this.#finish(this.#trials.follow(time, frame));
  }

  /** Records what happened to the match of the group: absences, its clock, and its loss. */
  #followMatch(): void {
    const { current } = this.#trials;
    if (!current) return;
    const absences = current.runner.takeAbsences?.() ?? [];
    for (const absence of absences) this.session.apply({ type: 'absence', absence });
    const { matchClock } = current;
    const { running, waiting } = this.session.progress;
    const changed = matchClock !== null && running && matchClock.runs === waiting;
    if (changed) this.session.apply({ type: 'match-clock', ...matchClock });
    if (changed || absences.length > 0) void this.exchange();
    if (!current.runner.interrupted) return;
    this.#inertSheet.expectChange();
    this.#apply({ type: 'reload' });
  }

  /** Records a round that is over while its end is still on display, before something else makes it void. */
  conclude(): void {
    this.#finish(this.#trials.conclude());
  }

  /** Called before a command of the experimenter is followed. */
  onCommand(): void {
    this.conclude();
    this.#inertSheet.expectChange();
  }

  /** Called when the headset was put on or taken off. */
  sessionChanged(): void {
    const worn = this.#host.inSession();
    if (!worn) this.conclude();
    const { running, paused } = this.session.progress;
    // A round is void if the headset comes off in the middle of it.
    if (!worn && running && !paused && this.#trials.current) this.#apply({ type: 'reload' });
    if (!worn) this.#measurement.cancel();
    this.show();
  }

  show(): void {
    const { session } = this;
    const { display } = this.#page;
    if (session.uploadStatus.lockedOut) {
      this.#trials.abort();
      display.ask(this.#lockedOutForm(), this.#host.inSession() ? lockedOutScreen(session) : null);
      return;
    }
    this.#settle();
    const form = this.#form();
    if (form) display.ask(form);
    else display.show(this.#inertSheet.shown(this.#screen()), this.#host.inSession());
  }

  #screenActions(): ScreenActions {
    return {
      apply: (event) => this.#apply(event),
      goTo: (index) => {
        this.#questionnaire.goTo(index);
        this.#showRejection(null);
      },
      choose: (question, value) => this.#showRejection(this.#questionnaire.choose(question, value)),
      type: (question, typed) => this.#showRejection(this.#questionnaire.type(question, typed)),
      submit: () => {
        if (this.#questionnaire.readyToSubmit()) this.#apply({ type: 'submit' });
        else this.#showRejection(null);
      },
      calibrate: () => this.#measurement.start(),
      enterVr: () => void this.#host.enterVr(),
      askToStop: (on) => {
        this.#stopping = on;
        this.show();
      },
      prepareAgain: () => {
        this.#trials.prepareAgain();
        this.show();
      },
    };
  }

  #screen() {
    const { current, prepared } = this.#trials;
    return screenOf(
      {
        session: this.session,
        inSession: this.#host.inSession(),
        questionnaire: this.#questionnaire,
        calibration: this.#measurement.step,
        withdrawalPage: this.#page.address.withdrawalPage(),
        setupProblems: this.#measurement.problems,
        prepared,
        rejection: this.#rejection,
        stopping: this.#stopping,
        playing: current !== null,
        waitingFor: current?.runner.waitingFor ?? null,
        standing: current?.runner.pausedByOther ?? false,
        awaited: this.#trials.awaited,
      },
      this.#actions,
    );
  }

  /** Returns the form that takes the place of a screen at the desk; null: none does. */
  #form(): StudyForm | null {
    const { session } = this;
    const { phrases, kept } = session;
    const { withdrawalCode } = kept;
    const stop = () => this.#apply({ type: 'stop', by: 'participant' });
    if (withdrawalCode !== null) {
      return {
        ...{ kind: 'code', phrases, code: withdrawalCode, withdrawalPage: this.#page.address.withdrawalPage() },
        noted: () => session.codeNoted(),
        stop: () => {
          session.codeNoted();
          stop();
        },
      };
    }
    if (session.step.kind !== 'demographics') return null;
    return { kind: 'demographics', phrases, stop, done: (answers) => this.#submitDemographics(answers) };
  }

  #lockedOutForm(): StudyForm {
    const { progress, plan, phrases, uploadStatus } = this.session;
    const reload = () => this.#page.address.reload();
    return {
      ...{ kind: 'locked-out', phrases, participant: progress.participant, unsent: uploadStatus.unsent },
      contact: plan.remote?.contact ?? null,
      // A device whose storage fails returns nothing either: after a reload the page starts as on another device.
      restart: () => void this.#forget().then(reload, reload),
    };
  }

  #tickLater(): void {
    this.#page.after(tickEveryMs, () => {
      this.#tickLater();
      if (this.session.step.kind === 'rest') {
        this.#inertSheet.expectChange();
        this.session.apply({ type: 'tick' });
      }
      this.show();
    });
  }

  /** Brings trials, body and questions up to the present step. */
  #settle(): void {
    const { step, simulated } = this.session;
    if (step.id !== this.#shownStep) this.#enterStep();
    this.#trials.settle();
    if (this.#trials.missed && this.session.apply({ type: 'missed' }) === null) {
      void this.exchange();
      this.#settle();
      return;
    }
    if (step.kind !== 'consent') this.#host.setActor(simulated);
  }

  #enterStep(): void {
    this.#shownStep = this.session.step.id;
    this.#rejection = null;
    this.#stopping = false;
    this.#measurement.reset();
    this.#questionnaire.enterStep();
    void this.#restoreBody();
  }

  async #restoreBody(): Promise<void> {
    const { step } = this.session;
    try {
      await this.#trials.restoreBody();
    } catch (error) {
      if (this.session.step !== step) return;
      this.#rejection = localizedReason(error, this.session.phrases);
      this.show();
    }
  }

  #finish(finished: FinishedTrial | null): void {
    if (!finished) return;
    const { outcome, recording } = finished;
    const { session } = this;
    const { attempt } = this.#trials;
    const rejection = session.apply({ type: 'trial-finished', outcome });
    this.#rejection = this.#inWords(rejection);
    if (recording !== null && rejection === null && session.progress.motion)
      session.keepMotion(`${attempt}:trial`, recording);
    void this.exchange();
  }

  #apply(event: ProgressEvent): void {
    this.conclude();
    this.#rejection = this.#inWords(this.session.apply(event));
    void this.exchange();
    this.show();
  }

  /** Shows why an action changed nothing; null: it did. */
  #showRejection(rejection: Rejection | null): void {
    this.#rejection = this.#inWords(rejection);
    this.show();
  }

  #inWords(rejection: Rejection | null): string | null {
    return rejection && localizedReason(rejection, this.session.phrases);
  }

  /** Returns why the answers are refused, or null if they are stored. */
  #submitDemographics(answers: Record<string, unknown>): string | null {
    const problem = this.session.apply({ type: 'demographics', demographics: answers });
    if (problem === null) {
      void this.exchange();
      this.#setBowSide();
    }
    this.show();
    return this.#inWords(problem);
  }

  /** Puts the bow into the hand that does not draw it. */
  #setBowSide(): void {
    const { preferredHand } = this.session.kept;
    if (preferredHand) this.#host.setBowSide(otherSide(preferredHand));
  }
}
