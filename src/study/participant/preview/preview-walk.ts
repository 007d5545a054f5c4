import type { CalibrationStep } from 'threepoint-ui';
import { type Phrases, phrasesOf } from '../../model/phrases/phrases';
import { embodimentInWords } from '../../model/plan/embodiment';
import { languagesOf, type StudyPlan, taskTitle } from '../../model/plan/plan';
import { type Schedule, type StudyStep, scheduleFor } from '../../model/plan/schedule';
import { applyEvent, type ProgressEvent } from '../../model/progress/apply-event';
import { begin, currentStep, type Progress } from '../../model/progress/progress';
import type { StudyForm } from '../forms/study-form';
import { localizedRefusal } from '../localized-reasons';
import { QuestionnaireState } from '../questionnaire-state';
import type { StudyScreen } from '../questions/study-screen';
import { screenOf } from '../screens/study-screens';
import type { ScreenActions, ShownSession, StudySituation } from '../screens/study-situation';
import type { UploadStatus } from '../session/participant-session';
import { type PreviewStop, previewStops } from './preview-stops';

/** The content of a stop: a screen, a form of the desk, or a sentence about a round. */
export type PreviewShown =
  | { readonly kind: 'screen'; readonly screen: StudyScreen }
  | { readonly kind: 'form'; readonly form: StudyForm }
  | { readonly kind: 'playing'; readonly text: string };

const allSaved: UploadStatus = {
  unsent: 0,
  unsaved: 0,
  storageFault: null,
  online: true,
  refusal: null,
  lockedOut: false,
};

/** An example in the format of a withdrawal code. */
const exampleCode = '0000-0000-0000-0000';

/** A session that can be moved to any step, keeps its answers in the page and records nothing. */
class PreviewSession implements ShownSession {
  readonly plan: StudyPlan;
  readonly simulated = false;
  readonly uploadStatus = allSaved;
  readonly schedule: Schedule;
  readonly #drafts = new Map<string, Progress['draft']>();
  #progress: Progress;

  constructor(plan: StudyPlan, participant: string, language: string) {
    this.plan = plan;
    this.schedule = scheduleFor(plan, participant);
    this.#progress = { ...begin(this.schedule), motion: false, language };
  }

  get progress(): Progress {
    return this.#progress;
  }

  get phrases(): Phrases {
    return phrasesOf(this.plan, this.#progress.language ?? languagesOf(this.plan)[0]);
  }

  get step(): StudyStep {
    return currentStep(this.schedule, this.#progress);
  }

  /** The clock always shows the beginning of a step. */
  remaining(): number | null {
    return 'seconds' in this.step ? this.step.seconds : null;
  }

  /** A participant at another step is not paused, not asked whether to stop, and has not stopped. */
  goTo(step: string): void {
    const { unwell: _, stopped: __, ...progress } = this.#progress;
    this.#progress = { ...progress, step, paused: false, draft: this.#drafts.get(step) ?? {} };
  }

  setLanguage(language: string): void {
    this.#progress = { ...this.#progress, language };
  }

  apply(event: ProgressEvent): string | null {
    const { progress, refusal } = applyEvent(this.schedule, this.#progress, event, 0);
    if (refusal !== null) return refusal;
    this.#drafts.set(this.#progress.step, event.type === 'answer' ? progress.draft : this.#progress.draft);
    this.#progress = { ...progress, draft: this.#drafts.get(progress.step) ?? {} };
    return null;
  }
}

export interface PreviewWalkOptions {
  readonly plan: StudyPlan;
  readonly participant: string;
  /** The address of the withdrawal page. */
  readonly withdrawalPage: string;
  /** Called when something else is to be shown. */
  readonly onChange: () => void;
}

/** Moves through every screen of a plan in any order; nothing is recorded. */
export class PreviewWalk {
  readonly stops: readonly PreviewStop[];
  readonly #session: PreviewSession;
  readonly #questionnaire: QuestionnaireState;
  readonly #onChange: () => void;
  readonly #actions: ScreenActions;
  readonly #withdrawalPage: string;
  #at = 0;
  #place: 'desk' | 'headset' = 'headset';
  #refusal: string | null = null;
  #stopping = false;

  constructor({ plan, participant, withdrawalPage, onChange }: PreviewWalkOptions) {
    this.stops = previewStops(plan, participant);
    this.#withdrawalPage = withdrawalPage;
    this.#session = new PreviewSession(plan, participant, languagesOf(plan)[0]);
    this.#questionnaire = new QuestionnaireState(this.#session);
    this.#onChange = onChange;
    const next = () => this.next();
    this.#actions = {
      apply: (event) => this.#apply(event),
      goTo: (index) => this.#goToQuestion(index),
      choose: (question, value) => this.#showRefusal(this.#questionnaire.choose(question, value)),
      type: (question, typed) => this.#showRefusal(this.#questionnaire.type(question, typed)),
      submit: () => (this.#questionnaire.readyToSubmit() ? this.#apply({ type: 'submit' }) : this.#followQuestion()),
      calibrate: next,
      enterVr: next,
      prepareAgain: next,
      askToStop: (on) => {
        this.#stopping = on;
        this.#onChange();
      },
    };
  }

  get plan(): StudyPlan {
    return this.#session.plan;
  }

  get participant(): string {
    return this.#session.schedule.participant;
  }

  get index(): number {
    return this.#at;
  }

  get stop(): PreviewStop {
    return this.stops[this.#at] as PreviewStop;
  }

  get language(): string {
    return this.#session.progress.language ?? languagesOf(this.plan)[0];
  }

  /** The place at which the stop is shown: most stops have only one. */
  get place(): 'desk' | 'headset' {
    const { at } = this.stop;
    return at === 'either' ? this.#place : at;
  }

  /** Shows stops that can be at either place at this one from now on. */
  showAt(place: 'desk' | 'headset'): void {
    this.#place = place;
    this.#onChange();
  }

  setLanguage(language: string): void {
    this.#session.setLanguage(language);
    this.#onChange();
  }

  next(): void {
    this.goTo(this.#at + 1);
  }

  back(): void {
    this.goTo(this.#at - 1);
  }

  /** Moves to a stop by its index, clamped to the list. */
  goTo(index: number): void {
    const at = Math.min(this.stops.length - 1, Math.max(0, index));
    const { step } = this.stops[at] as PreviewStop;
    const { paused, unwell } = this.#session.progress;
    const leaves = this.#session.step.id !== step;
    if (leaves || paused || unwell) this.#session.goTo(step);
    if (leaves) this.#questionnaire.enterStep();
    this.#moveTo(at);
  }

  /** Moves to a stop within the present step. */
  #moveTo(index: number): void {
    this.#at = index;
    this.#stopping = false;
    this.#questionnaire.goTo(this.stop.question);
    this.#showRefusal(null);
  }

  /** Returns the content of this stop. */
  shown(): PreviewShown {
    const { kind } = this.stop;
    const form = this.#form();
    if (form) return { kind: 'form', form };
    const screen = kind === 'playing' ? null : screenOf(this.#situation(), this.#actions);
    return screen ? { kind: 'screen', screen } : { kind: 'playing', text: this.#playedText() };
  }

  #form(): StudyForm | null {
    const { plan, phrases } = this.#session;
    const next = () => this.next();
    switch (this.stop.kind) {
      case 'consent': {
        const { id, title, consent, remote, phrases: given = {} } = plan;
        const contact = remote?.contact ?? null;
        const study = { id, title, consent, languages: languagesOf(plan), phrases: given, simulated: false, contact };
        const agree = async () => {
          next();
          return null;
        };
        const { language } = this;
        return { kind: 'consent', phrases, language, study, participant: this.participant, agree, decline: next };
      }
      case 'code':
        return {
          kind: 'code',
          phrases,
          code: exampleCode,
          withdrawalPage: this.#withdrawalPage,
          noted: next,
          stop: () => this.goTo(this.stops.length),
        };
      case 'demographics':
        return {
          kind: 'demographics',
          phrases,
          stop: () => this.goTo(this.stops.length),
          done() {
            next();
            return null;
          },
        };
      default:
        return null;
    }
  }

  #situation(): StudySituation {
    const { kind } = this.stop;
    const measuring: CalibrationStep = { kind: 'measuring', part: 0.5 };
    return {
      session: this.#session,
      inSession: kind !== 'enter',
      questionnaire: this.#questionnaire,
      calibration: kind === 'measuring' ? measuring : null,
      prepared: { state: 'ready', reason: '' },
      refusal: this.#refusal,
      stopping: this.#stopping,
      withdrawalPage: this.#withdrawalPage,
      setupFaults: [],
      playing: kind === 'waiting',
      waitingFor: kind === 'waiting' ? this.#others() : null,
      standing: false,
    };
  }

  #others(): readonly string[] {
    const { step, schedule } = this.#session;
    const members = 'task' in step ? (schedule.groups[step.task]?.members ?? []) : [];
    return members.filter((member) => member !== this.participant);
  }

  #playedText(): string {
    const { step, plan } = this.#session;
    if (step.kind !== 'trial' && step.kind !== 'tutorial') return '';
    const what = step.kind === 'trial' ? `Condition “${step.condition}”` : 'Practice';
    return `${taskTitle(plan, step.task)}: the participant plays, ${Math.round(step.seconds)} s at most. ${what}: ${embodimentInWords(step.embodiment)}.`;
  }

  #apply(event: ProgressEvent): void {
    if (event.type === 'start') {
      this.next();
      return;
    }
    const { id } = this.#session.step;
    const refusal = localizedRefusal(this.#session.apply(event), this.#session.phrases);
    const { step } = this.#session;
    if (step.id === id) this.#showRefusal(refusal);
    // Not by goTo, because the answers that were handed in may lead to the question whether to stop.
    else this.#moveTo(this.stops.findIndex((stop) => stop.step === step.id));
  }

  #goToQuestion(index: number): void {
    this.#questionnaire.goTo(index);
    this.#followQuestion();
  }

  /** Moves the position in the list to the question on display. */
  #followQuestion(): void {
    const { step } = this.stop;
    this.#at = this.stops.findIndex((stop) => stop.step === step && stop.question === this.#questionnaire.question);
    this.#showRefusal(null);
  }

  #showRefusal(refusal: string | null): void {
    this.#refusal = refusal;
    this.#onChange();
  }
}
