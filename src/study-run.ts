import './styles/study.css';
import type { ArcheryFrame } from './archery-play';
import type { BallFrame } from './ball-play';
import type { Calibration } from './core/body/calibration';
import type { Side } from './core/body/joints';
import type { EstimatorName } from './core/estimation/pose-estimator';
import { rotate } from './core/math/quat';
import { vec3 } from './core/math/vec3';
import { type StudyStep, scheduleFor } from './core/study/plan';
import { type Progress, placeOf } from './core/study/progress';
import { randomFor } from './core/study/shuffle';
import type { PublicStudy } from './core/study/study-api';
import { createTrialLog, type TrialLog, type TrialOutcome } from './core/study/trial-log';
import { writeRecording } from './core/tracking/recording';
import type { TrackingFrame } from './core/tracking/tracking-frame';
import type { FrameListener } from './frame-timing';
import { reasonOf } from './reasons';
import { createParticipantSession, isLater, type ParticipantSession, startSession } from './study/participant-session';
import { createParticipantClient, ServerRefusal, ServerUnreachable } from './study/study-client';
import { type KeptSession, openStudyVault, type StudyVault } from './study/study-vault';
import type { TaskEvent, TaskPlace, TaskRunner } from './study/task-runner';
import { type ArcheryHost, createArcheryRunner } from './study-archery';
import { type BallHost, createBallRunner } from './study-ball';
import { lockedOutScreen, type StudySituation, screenOf, screenQuestions } from './study-screens';
import type { CalibrationStep } from './ui/calibration-dialog';
import { type CalibrationGuide, createCalibrationGuide } from './ui/calibration-guide';
import { element } from './ui/element';
import { consentForm, createStudyCard, demographicsForm, participantForm } from './ui/study-card';
import type { StudyScreen } from './ui/study-screen';
import type { Pointer } from './ui/vr-pointers';
import { createVrStudyPanel, type VrStudyPanel } from './ui/vr-study-panel';

/** What the study needs of the page; the page decides how. */
export interface StudyHost extends ArcheryHost, BallHost {
  enterVr(): Promise<void>;
  inSession(): boolean;
  calibration(): Calibration;
  /** Of this participant, for this visit; not remembered for others. */
  setCalibration(calibration: Calibration): void;
  /** Resolves when it draws, or when it turned out that it cannot. */
  chooseEstimator(name: EstimatorName): Promise<void>;
  estimator(): EstimatorName;
  setActor(on: boolean): void;
  setBowSide(side: Side): void;
  device(): TrialOutcome['device'];
  listenToFrames(listener: FrameListener | null): void;
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
  /** Every frame of the round on the page. */
  played(frame: ArcheryFrame): void;
  /** Every frame of the match on the page. */
  playedBall(frame: BallFrame): void;
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
/** The end of a round is seen before the sheet comes [s]. */
const afterglow = 2.5;
/** Tracked frames kept per trial: some 14 MB, below what the server takes at once. */
const mostMotionFrames = 40_000;
/** Eyes this far below where calibration found them are those of somebody who sat down [m]. */
const seatedDrop = 0.25;

const nowSeconds = () => Date.now() / 1000;

type PlayedStep = Extract<StudyStep, { kind: 'trial' | 'tutorial' }>;

/** A trial that is being played. */
interface Trial {
  readonly step: PlayedStep;
  /** Step, run and attempt: when it changes under the trial, the trial is void. */
  readonly key: string;
  readonly log: TrialLog;
  readonly frames: TrackingFrame[] | null;
  startTime: number | null;
  lastTime: number;
  endedAt: number | null;
  fellBack: boolean;
}

/** Opens the study that the address asks for; the page shows nothing of its own while it runs. */
export function createStudyRun(
  asked: { readonly study: string; readonly participant: string | null },
  host: StudyHost,
): StudyRun {
  document.body.classList.add('in-study');
  const client = createParticipantClient();
  const card = createStudyCard();
  const sheet = createVrStudyPanel();
  const archery = createArcheryRunner(host);
  const ball = createBallRunner(host);
  const runners: Partial<Record<string, TaskRunner>> = { archery, ball };

  let session: ParticipantSession | null = null;
  let screen: StudyScreen | null = null;
  let screenId = 'opening';
  let question = 0;
  let triedToSubmit = false;
  let calibrationStep: CalibrationStep | null = null;
  let refusal: string | null = null;
  let fault: string | null = null;
  let trial: Trial | null = null;
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
    // What went wrong stays to be read until somebody measures again.
    closesItself: () => false,
  });

  const runnerOf = (step: { readonly task: string }): TaskRunner | null => {
    const game = session?.plan.tasks.find(({ id }) => id === step.task)?.game;
    return (game && runners[game]) ?? null;
  };

  const played = (step: StudyStep): step is PlayedStep => step.kind === 'trial' || step.kind === 'tutorial';

  /** Where a group meets: a room of its own for every trial of every run, which nobody can guess from another study. */
  function placeFor(step: PlayedStep): TaskPlace {
    const running = session as ParticipantSession;
    const group = running.schedule.groups[step.task];
    const run = running.progress.runs[`${step.task}/${step.block}`] ?? 1;
    const name = `${running.plan.id} ${step.id} ${run} ${group?.number}`;
    const [first, second] = ['room', 'again'].map((purpose) =>
      (randomFor(running.plan.seed, `${purpose} ${name}`).seed >>> 0).toString(36),
    );
    return {
      room: `study-${first}${second}`,
      participant: running.progress.participant,
      members: group?.members ?? [],
    };
  }

  /** Whether a trial has been started that cannot begin yet. */
  const waiting = () => trial !== null && (runnerOf(trial.step)?.waitingFor ?? null) !== null;

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
    trial = {
      step,
      key: keyOf(running),
      log: createTrialLog(host.device(), host.calibration()),
      frames: motion ? [] : null,
      startTime: null,
      lastTime: 0,
      endedAt: null,
      fellBack: false,
    };
    for (const name of runner.assists()) trial.log.assist(name);
    const { log } = trial;
    host.listenToFrames((spent, late) => {
      if (session && !session.progress.paused && trial?.endedAt === null && !waiting()) log.frame(spent, late);
    });
    // The same round for everybody's first, second … trial: what differs between conditions is not the layout.
    const repetition = step.kind === 'trial' ? step.repetition : 0;
    const { seed } = randomFor(running.plan.seed, `layout of ${step.task} ${repetition}`);
    runner.start({ seed: seed >>> 1, seconds: step.seconds });
    show();
  }

  function dropTrial(): void {
    if (!trial) return;
    runnerOf(trial.step)?.abort();
    trial = null;
    host.listenToFrames(null);
  }

  function finishTrial(running: ParticipantSession, done: Trial, runner: TaskRunner): void {
    const { end } = runner;
    if (!end) return;
    host.listenToFrames(null);
    trial = null;
    runner.abort();
    const recorded = done.frames && done.frames.length > 0 ? done.frames : null;
    const outcome = done.log.finish({ ...end, motionFrames: recorded?.length ?? 0 });
    const place = placeOf(running.schedule, running.progress);
    refusal = running.apply({ type: 'trial-finished', outcome });
    if (recorded && place && refusal === null) {
      const recording = {
        device: outcome.device.name,
        rateHz: outcome.device.refreshRateHz ?? 60,
        calibration: outcome.calibration,
      };
      running.keepMotion(
        `${done.step.id}@${place.run}.${place.attempt}:trial`,
        writeRecording({ ...recording, frames: recorded }),
      );
    }
    void exchange();
  }

  /** What follows from where the session is now, whoever brought it there. */
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
    if (played(step)) {
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
      waitingFor: trial ? (runnerOf(trial.step)?.waitingFor ?? null) : null,
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
      card.form('fault', () => [
        element('p', { class: 'kicker trouble' }, 'Study'),
        element('h1', {}, 'The study cannot go on here'),
        element('p', {}, said),
      ]);
      sheet.show(null);
      return;
    }
    const running = session;
    if (!running) return;
    if (running.safekeeping.lockedOut) {
      screenId = 'locked-out';
      dropTrial();
      card.form('locked-out', () => lockedOutNodes(running));
      sheet.show(host.inSession() ? lockedOutScreen(running) : null);
      return;
    }
    settle();
    if (running.withdrawalCode !== null) {
      screenId = 'code';
      const code = running.withdrawalCode;
      card.form('code', () => codeNodes(code));
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
            if (hand) host.setBowSide(hand === 'left' ? 'right' : 'left');
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

  function codeNodes(code: string): readonly Node[] {
    const noted = element('button', { type: 'button', class: 'primary' }, 'I have noted it');
    noted.addEventListener('click', actions.codeNoted);
    return [
      element('p', { class: 'kicker' }, 'Your withdrawal code'),
      element('h1', {}, 'Please write this down'),
      element('p', {}, element('code', {}, code)),
      element(
        'p',
        {},
        'Whoever gives this code to the experimenter has everything deleted that was recorded under it. It is shown only now, and nobody can look it up later.',
      ),
      element('div', { class: 'row' }, noted),
    ];
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
    if (opened.preferredHand) host.setBowSide(opened.preferredHand === 'left' ? 'right' : 'left');
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

  async function openVault(): Promise<StudyVault | null> {
    try {
      return await openStudyVault();
    } catch {
      // reason: a browser without storage is a state of the session (safekeeping.storageFault), shown on every screen
      return null;
    }
  }

  /** One page per participant: two would tell the server two stories. */
  function alone(participant: string): Promise<boolean> {
    if (!navigator.locks) return Promise.resolve(true);
    return new Promise((resolve) => {
      void navigator.locks.request(`threepoint study ${asked.study} ${participant}`, { ifAvailable: true }, (lock) => {
        resolve(lock !== null);
        // Held until the page goes.
        return lock && new Promise(() => undefined);
      });
    });
  }

  /** What the server knows of a session; null: nothing, or it does not answer now. */
  async function reportedProgress({ study, participant, token }: KeptSession): Promise<Progress | null> {
    try {
      return await client.progress(study, participant, token);
    } catch (error) {
      if (error instanceof ServerUnreachable || error instanceof ServerRefusal) return null;
      throw error;
    }
  }

  /** This device is no longer the participant's: whoever sits here may begin anew. */
  function lockedOutNodes(running: ParticipantSession): readonly Node[] {
    const { unsent } = running.safekeeping;
    const anew = element('button', { type: 'button' }, 'Forget it here and begin anew');
    anew.addEventListener('click', () => {
      void openVault()
        .then((vault) => vault?.forget(asked.study, running.progress.participant))
        .then(() => location.reload());
    });
    return [
      element('p', { class: 'kicker trouble' }, 'Study'),
      element('h1', {}, 'Please call the experimenter'),
      element(
        'p',
        {},
        `${running.progress.participant} was released for another device, or what was recorded was deleted. This device sends nothing more.`,
      ),
      ...(unsent > 0
        ? [
            element(
              'p',
              { class: 'hint' },
              `${unsent} records were never sent. Beginning anew deletes them from this device.`,
            ),
          ]
        : []),
      element('div', { class: 'row' }, anew),
    ];
  }

  async function open(participant: string): Promise<void> {
    if (!(await alone(participant)))
      throw new Error(`${participant} is open in another tab of this browser. Go on there, or close it.`);
    const vault = await openVault();
    const kept = (await vault?.session(asked.study, participant)) ?? null;
    const options = { client, vault, now: nowSeconds, onChange: () => show() };
    if (kept && vault) {
      const [records, motion] = await Promise.all([
        vault.records(asked.study, participant),
        vault.motion(asked.study, participant),
      ]);
      const known = await reportedProgress(kept);
      const current =
        known && isLater(scheduleFor(kept.plan, participant), known, kept.progress)
          ? { ...kept, progress: known }
          : kept;
      const opened = createParticipantSession(current, { records, motion }, options);
      opened.apply({ type: 'reload' });
      begin(opened);
      return;
    }
    const study = await client.study(asked.study);
    screenId = 'consent';
    card.form(
      'consent',
      () =>
        consentForm(
          study.consent,
          study.simulated ? 'This study is SIMULATED: what is recorded is marked as made by a program.' : null,
          {
            async agree(motion) {
              try {
                const claim = await client.claim(asked.study, participant);
                const opened = createParticipantSession(
                  startSession(claim, asked.study, participant),
                  { records: [], motion: [] },
                  options,
                );
                if (opened.step.kind === 'consent') {
                  const said = opened.apply({ type: 'consent', motion, version: study.consent.version });
                  if (said !== null) return said;
                } else opened.apply({ type: 'reload' });
                begin(opened);
                return null;
              } catch (error) {
                return reasonOf(error);
              }
            },
            decline: () => declined(study),
          },
        ),
      `${study.title} · ${participant}`,
    );
  }

  function declined(study: PublicStudy): void {
    screenId = 'declined';
    card.form('declined', () => [
      element('p', { class: 'kicker' }, study.title),
      element('h1', {}, 'Thank you all the same'),
      element('p', {}, 'Nothing was recorded. You can close this page.'),
    ]);
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

  if (asked.participant === null) {
    screenId = 'participant';
    card.form('participant', () =>
      participantForm('Who takes part?', (participant) => {
        const address = new URL(location.href);
        address.searchParams.set('participant', participant);
        location.assign(address);
      }),
    );
  } else opening(asked.participant);

  function log(event: TaskEvent, to: TrialLog): void {
    if (event.type === 'shot') to.shot();
    else to.event(event);
  }

  return {
    object: sheet.object,
    get idle() {
      return trial === null || waiting();
    },
    get measured() {
      return session?.calibration != null;
    },
    get paused() {
      return session?.progress.paused ?? false;
    },
    frame(time, frame) {
      if (frame) {
        guide.observe(frame);
        const forward = rotate(frame.head.orientation, vec3(0, 0, -1));
        sheet.follow({ position: frame.head.position, forward });
      }
      const running = session;
      if (!trial || !running || running.progress.paused) return;
      const runner = runnerOf(trial.step);
      if (!runner || runner.waitingFor !== null) return;
      if (trial.startTime === null) {
        trial.startTime = time;
        const eyes = frame?.head.position.y ?? host.calibration().eyeHeight;
        if (eyes < host.calibration().eyeHeight - seatedDrop) trial.log.assist('seated');
      }
      for (const event of runner.take()) log(event, trial.log);
      if (trial.endedAt === null) {
        const seen = { head: frame !== null, leftHand: frame?.leftHand != null, rightHand: frame?.rightHand != null };
        trial.log.tracked(time - trial.startTime, seen);
        if (host.estimator() !== trial.step.estimator && !trial.fellBack) {
          trial.fellBack = true;
          trial.log.assist(`estimator fell back to ${host.estimator()}`);
        }
        const { frames } = trial;
        if (frame && frames && frames.length < mostMotionFrames && time > trial.lastTime) frames.push(frame);
        trial.lastTime = time;
        if (runner.end) trial.endedAt = time;
      } else if (time - trial.endedAt > afterglow) finishTrial(running, trial, runner);
    },
    played: (frame) => archery.played(frame),
    playedBall: (frame) => ball.played(frame),
    point: (pointers) => sheet.point(pointers),
    sessionChanged() {
      // Whoever takes the headset off in the middle of a round has not played it.
      if (!host.inSession() && session?.progress.running && trial) {
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
