import type { Side } from '../../core/math/side';
import '../../styles/study.css';
import type { Calibration } from '../../core/body/calibration';
import { reasonOf } from '../../core/errors/reasons';
import type { EstimatorName } from '../../core/estimation/pose-estimator';
import { rotate } from '../../core/math/quat';
import { vec3 } from '../../core/math/vec3';
import { placeOf } from '../../core/study/progress';
import { randomFor } from '../../core/study/shuffle';
import type { PublicStudy } from '../../core/study/study-api';
import { neverBack } from '../../core/tracking/page-clock';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import { createParticipantClient, ServerRefusal } from '../../net/study-client';
import { invitationIn, studyLink } from '../../net/study-link';
import type { CalibrationStep } from '../../ui/calibration-dialog';
import { type CalibrationGuide, createCalibrationGuide } from '../../ui/calibration-guide';
import type { Pointer } from '../../ui/vr-pointers';
import type { ParticipantSession } from './participant-session';
import {
  consentForm,
  createStudyCard,
  demographicsForm,
  lastWords,
  lockedOutForm,
  participantForm,
  withdrawalForm,
} from './study-card';
import { forgetSession, type Opened, openSession } from './study-opening';
import type { StudyScreen } from './study-screen';
import { lockedOutScreen, type StudySituation, screenOf, screenQuestions } from './study-screens';
import {
  type FinishedTrial,
  isPlayed,
  type PlayedStep,
  type PlayedTrial,
  playTrial,
  type TrialHost,
} from './study-trial';
import type { TaskPlace, TaskRunner } from './task-runner';
import { createVrStudyPanel, type VrStudyPanel } from './vr-study-panel';

/** What the study needs of the page; the page decides how. */
export interface StudyHost extends TrialHost {
  /** The games this page can play as tasks, by the name that plans call them. */
  readonly runners: Readonly<Partial<Record<string, TaskRunner>>>;
  enterVr(): Promise<void>;
  inSession(): boolean;
  /** Of this participant, for this visit; not remembered for others. */
  setCalibration(calibration: Calibration): void;
  /** Resolves when it draws, or when it turned out that it cannot. */
  chooseEstimator(name: EstimatorName): Promise<void>;
  setActor(on: boolean): void;
  setBowSide(side: Side): void;
}

/** The study on the page, as its frame loop sees it. */
export interface StudyRun {
  /** For the scene. */
  readonly object: VrStudyPanel['object'];
  /** Nobody plays now: hands that point at the sheet draw no bow. */
  readonly idle: boolean;
  /** Whether the participant's body has been measured: no guess may take its place. */
  readonly measured: boolean;
  /** Whether the round on the page stands still. */
  readonly paused: boolean;
  /** Every frame drawn; null: the head was not seen. */
  frame(time: number, frame: TrackingFrame | null): void;
  point(pointers: readonly Pointer[]): void;
  sessionChanged(): void;
  probe(): StudyProbe;
}

/** What tools may know of a study on the page. */
export interface StudyProbe {
  readonly screen: string;
  readonly step: string | null;
  readonly simulated: boolean;
  readonly running: boolean;
  readonly unsent: number;
  readonly unsaved: number;
  readonly online: boolean;
  /** What can be pressed on the sheet in the headset, and where its middle is [m]. */
  readonly pointedAt: string | null;
  readonly targets: readonly { readonly id: string; readonly at: readonly [number, number, number] }[];
}

/** How often the device talks to the server, and how seldom when it does not answer [ms]. */
const exchangeEveryMs = 2000;
const slowestExchangeMs = 15_000;
const tickEveryMs = 250;
/** Seconds since 1970, in order even where the system's clock is set back. */
const nowSeconds = neverBack(() => Date.now() / 1000);

/** The bow goes into the other hand. */
const bowSideOf = (preferred: Side): Side => (preferred === 'left' ? 'right' : 'left');

/** Opens the study that the address asks for; the page shows nothing of its own while it runs. */
export function createStudyRun(
  asked: { readonly study: string; readonly participant: string | null },
  host: StudyHost,
): StudyRun {
  document.body.classList.add('in-study');
  const client = createParticipantClient();
  const card = createStudyCard();
  const sheet = createVrStudyPanel();

  let session: ParticipantSession | null = null;
  let screen: StudyScreen | null = null;
  let screenId = 'opening';
  let question = 0;
  let triedToSubmit = false;
  let calibrationStep: CalibrationStep | null = null;
  let refusal: string | null = null;
  let fault: string | null = null;
  let trial: PlayedTrial | null = null;
  let prepared: { readonly step: string; state: 'loading' | 'ready' | 'failed'; reason: string } | null = null;
  let lastStepId = '';
  let exchangeTimer = 0;
  let delayMs = exchangeEveryMs;

  const guide: CalibrationGuide = createCalibrationGuide({
    onStep(step) {
      calibrationStep = step;
      show();
    },
    onMeasured(calibration) {
      host.setCalibration(calibration);
      guide.cancel();
      session?.apply({ type: 'calibrated', calibration });
    },
    // What went wrong stays to be read until the participant measures again.
    closesItself: () => false,
  });

  const runnerOf = (step: { readonly task: string }): TaskRunner | null => {
    const game = session?.plan.tasks.find(({ id }) => id === step.task)?.game;
    return (game && host.runners[game]) ?? null;
  };

  /** Where a group meets: a room of its own for every trial of every run, on a seat that the server signs. */
  function placeFor(step: PlayedStep): TaskPlace {
    const running = session as ParticipantSession;
    const run = running.progress.runs[`${step.task}/${step.block}`] ?? 1;
    return {
      seat: () => running.seat({ step: step.id, run }),
      participant: running.progress.participant,
      members: running.schedule.groups[step.task]?.members ?? [],
      seconds: step.seconds,
    };
  }

  /** Whether a trial has been started that cannot begin yet. */
  const waiting = () => trial !== null && trial.waitingFor !== null;

  /** Loads the game and the body of the step at hand, before anybody can start it. */
  async function prepare(step: PlayedStep): Promise<void> {
    const attempt = { step: step.id, state: 'loading' as 'loading' | 'ready' | 'failed', reason: '' };
    prepared = attempt;
    try {
      const runner = runnerOf(step);
      if (!runner) throw new Error('This page cannot play the game of this task.');
      await Promise.all([runner.prepare(placeFor(step)), host.chooseEstimator(step.estimator)]);
      if (prepared !== attempt) return;
      if (host.estimator() !== step.estimator) throw new Error('The body of this round could not be loaded.');
      attempt.state = 'ready';
    } catch (error) {
      if (prepared !== attempt) return;
      attempt.state = 'failed';
      attempt.reason = reasonOf(error);
    }
    show();
  }

  const keyOf = (running: ParticipantSession) => {
    const place = placeOf(running.schedule, running.progress);
    return `${running.step.id}@${place?.run}.${place?.attempt}`;
  };

  function startTrial(step: PlayedStep, running: ParticipantSession): void {
    const runner = runnerOf(step);
    if (!runner) return;
    const motion = running.progress.motion === true && running.plan.consent.motion !== null && step.kind === 'trial';
    // The same round for each participant's first, second … trial: what differs between conditions is not the layout.
    const repetition = step.kind === 'trial' ? step.repetition : 0;
    const { seed } = randomFor(running.plan.seed, `layout of ${step.task} ${repetition}`);
    trial = playTrial(step, runner, host, { key: keyOf(running), motion, seed: seed >>> 1 });
    show();
  }

  function dropTrial(): void {
    trial?.abort();
    trial = null;
  }

  function finishTrial(running: ParticipantSession, { outcome, recording }: FinishedTrial): void {
    trial = null;
    const { step } = running;
    const place = placeOf(running.schedule, running.progress);
    refusal = running.apply({ type: 'trial-finished', outcome });
    if (recording !== null && place && refusal === null)
      running.keepMotion(`${step.id}@${place.run}.${place.attempt}:trial`, recording);
    void exchange();
  }

  /** What follows from where the session is now, however it came there. */
  function settle(): void {
    const running = session;
    if (!running) return;
    const { step } = running;
    if (step.id !== lastStepId) {
      lastStepId = step.id;
      question = 0;
      triedToSubmit = false;
      refusal = null;
      guide.cancel();
      if (step.kind === 'questionnaire') {
        // After a reload it goes on where the first answer is missing.
        const { progress } = running;
        const ids = questionIds(running);
        question = Math.max(
          0,
          ids.findIndex((id) => progress.draft[id] === undefined),
        );
      }
    }
    if (trial && trial.key !== keyOf(running)) dropTrial();
    // Whoever takes the headset off in a pause goes on when they wear it again.
    trial?.pause(running.progress.paused || !host.inSession());
    if (isPlayed(step)) {
      if (prepared?.step !== step.id) void prepare(step);
      if (
        running.progress.running &&
        !trial &&
        !running.progress.paused &&
        prepared?.state === 'ready' &&
        host.inSession()
      ) {
        startTrial(step, running);
      }
    }
    if (step.kind !== 'consent') host.setActor(running.simulated);
  }

  const questionIds = (running: ParticipantSession): readonly string[] => screenQuestions(running).map(({ id }) => id);

  function situation(running: ParticipantSession): StudySituation {
    return {
      session: running,
      inSession: host.inSession(),
      question,
      triedToSubmit,
      calibration: calibrationStep,
      prepared: prepared && prepared.step === running.step.id ? prepared : null,
      refusal,
      playing: trial !== null,
      waitingFor: trial?.waitingFor ?? null,
      standing: trial?.standing ?? false,
    };
  }

  const actions = {
    apply(event: Parameters<ParticipantSession['apply']>[0]) {
      refusal = session?.apply(event) ?? null;
      void exchange();
      show();
    },
    goTo(index: number) {
      question = index;
      show();
    },
    choose(id: string, value: number) {
      refusal = session?.apply({ type: 'answer', question: id, value }) ?? null;
      show();
    },
    submit() {
      const running = session;
      if (!running) return;
      const open = questionIds(running).findIndex((id) => running.progress.draft[id] === undefined);
      if (open >= 0) {
        triedToSubmit = true;
        question = open;
        show();
        return;
      }
      actions.apply({ type: 'submit' });
    },
    calibrate: () => guide.start(),
    enterVr: () => void host.enterVr(),
    prepareAgain() {
      prepared = null;
      settle();
      show();
    },
    codeNoted() {
      session?.codeNoted();
    },
  };

  function show(): void {
    if (fault !== null) {
      screenId = 'fault';
      const said = fault;
      card.form('fault', () => lastWords('Study', 'The study cannot go on here', said, true));
      sheet.show(null);
      return;
    }
    const running = session;
    if (!running) return;
    if (running.safekeeping.lockedOut) {
      screenId = 'locked-out';
      dropTrial();
      const { participant } = running.progress;
      card.form('locked-out', () =>
        lockedOutForm(participant, running.safekeeping.unsent, () => {
          void forgetSession({ study: asked.study, participant }).then(() => location.reload());
        }),
      );
      sheet.show(host.inSession() ? lockedOutScreen(running) : null);
      return;
    }
    settle();
    if (running.withdrawalCode !== null) {
      screenId = 'code';
      const code = running.withdrawalCode;
      card.form('code', () => withdrawalForm(code, actions.codeNoted));
      sheet.show(null);
      return;
    }
    if (running.step.kind === 'demographics') {
      screenId = 'demographics';
      card.form('demographics', () =>
        demographicsForm((answers) => {
          const said = running.apply({ type: 'demographics', demographics: answers });
          if (said === null) {
            void exchange();
            const hand = running.preferredHand;
            if (hand) host.setBowSide(bowSideOf(hand));
          }
          show();
          return said;
        }),
      );
      sheet.show(null);
      return;
    }
    screen = screenOf(situation(running), actions);
    screenId = screen?.id ?? 'playing';
    const inside = host.inSession();
    card.show(inside ? null : screen);
    sheet.show(inside ? screen : null);
  }

  async function exchange(): Promise<void> {
    const running = session;
    if (!running) return;
    window.clearTimeout(exchangeTimer);
    await running.exchange();
    delayMs = running.safekeeping.online ? exchangeEveryMs : Math.min(slowestExchangeMs, delayMs * 1.5);
    window.clearTimeout(exchangeTimer);
    exchangeTimer = window.setTimeout(() => void exchange(), delayMs);
  }
  window.addEventListener('online', () => void exchange());

  function begin(opened: ParticipantSession): void {
    session = opened;
    if (opened.calibration) host.setCalibration(opened.calibration);
    if (opened.preferredHand) host.setBowSide(bowSideOf(opened.preferredHand));
    window.setInterval(() => {
      if (opened.step.kind === 'rest') opened.apply({ type: 'tick' });
      show();
    }, tickEveryMs);
    window.addEventListener('beforeunload', (event) => {
      const { unsaved, unsent } = opened.safekeeping;
      if (unsaved > 0 && unsent > 0) event.preventDefault();
    });
    show();
    void exchange();
  }

  async function open(participant: string): Promise<void> {
    const seat = { study: asked.study, participant };
    const opened = await openSession(seat, { client, now: nowSeconds, onChange: () => show() });
    const invitation = invitationIn(location.hash);
    if (opened.kind === 'resumed') begin(opened.session);
    else if (invitation === null) askWho();
    else askForConsent(opened, participant, invitation);
  }

  /** Participant and invitation, as far as the address does not say them; `complaint`: what was wrong with what it says. */
  function askWho(complaint: string | null = null): void {
    screenId = 'participant';
    const known = { participant: asked.participant, invitation: invitationIn(location.hash) };
    // A whole link put into the address of this tab differs behind "#" alone, which loads nothing anew.
    window.addEventListener('hashchange', () => location.reload());
    card.form('participant', () =>
      participantForm({ title: 'Who takes part?', complaint }, known, (said) => {
        const address = new URL(location.href);
        address.searchParams.set('participant', said.participant);
        address.hash = new URL(studyLink({ study: asked.study, ...said }), location.origin).hash;
        if (address.href === location.href) location.reload();
        else location.assign(address);
      }),
    );
  }

  function askForConsent(
    { study, agree }: Extract<Opened, { kind: 'new' }>,
    participant: string,
    invitation: string,
  ): void {
    screenId = 'consent';
    const notice = study.simulated ? 'This study is SIMULATED: what is recorded is marked as made by a program.' : null;
    const actions = {
      async agree(motion: boolean) {
        const taken = await agree(motion, invitation);
        if (taken === 'uninvited') {
          askWho(`This is not the invitation of ${participant}. Compare it with your link, or ask the experimenter.`);
          return null;
        }
        if ('why' in taken) return taken.why;
        begin(taken);
        return null;
      },
      decline: () => declined(study),
    };
    card.form('consent', () => consentForm(study.consent, notice, actions), `${study.title} · ${participant}`);
  }

  function declined({ title }: PublicStudy): void {
    screenId = 'declined';
    card.form('declined', () =>
      lastWords(title, 'Thank you all the same', 'Nothing was recorded. You can close this page.', false),
    );
  }

  function opening(participant: string): void {
    open(participant).catch((error: unknown) => {
      fault =
        error instanceof ServerRefusal && error.status === 404
          ? `There is no study "${asked.study}" on this server. The experimenter's page begins one.`
          : reasonOf(error);
      show();
    });
  }

  if (asked.participant === null) askWho();
  else opening(asked.participant);

  return {
    object: sheet.object,
    get idle() {
      return trial === null || waiting();
    },
    get measured() {
      return session?.calibration != null;
    },
    get paused() {
      return session !== null && (session.progress.paused || (trial !== null && !host.inSession()));
    },
    frame(time, frame) {
      if (frame) {
        guide.observe(frame);
        const forward = rotate(frame.head.orientation, vec3(0, 0, -1));
        sheet.follow({ position: frame.head.position, forward });
      }
      const running = session;
      if (!trial || !running) return;
      const finished = trial.follow(time, frame);
      if (finished) finishTrial(running, finished);
    },
    point: (pointers) => sheet.point(pointers),
    sessionChanged() {
      // Whoever takes the headset off in the middle of a round has not played it.
      if (!host.inSession() && session?.progress.running && !session.progress.paused && trial) {
        session.apply({ type: 'reload' });
        void exchange();
      }
      if (!host.inSession()) guide.cancel();
      show();
    },
    probe: () => ({
      screen: screenId,
      step: session?.step.id ?? null,
      simulated: session?.simulated ?? false,
      running: trial !== null && !waiting(),
      unsent: session?.safekeeping.unsent ?? 0,
      unsaved: session?.safekeeping.unsaved ?? 0,
      online: session?.safekeeping.online ?? true,
      pointedAt: sheet.pointedAt,
      targets: sheet.targets(),
    }),
  };
}
