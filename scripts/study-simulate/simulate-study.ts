import { advance, type ProgressEvent } from '../../src/core/study/advance';
import { participantsOf, type Schedule, type StudyPlan, type StudyStep, scheduleFor } from '../../src/core/study/plan';
import { begin, currentStep, type Progress, resumed } from '../../src/core/study/progress';
import { type Demographics, questionnaires } from '../../src/core/study/questionnaires';
import type { StudyRecord } from '../../src/core/study/study-record';
import type { TrialOutcome } from '../../src/core/study/trial-log';
import { type AnswerModel, drawAnswers, drawPerson } from './answer-model';
import { drawArchery, drawBall, drawPlayer, type PerformanceModel, type Player } from './performance-model';
import { type RandomSource, randomSource } from './random-source';

export interface SimulationModels {
  readonly answers: AnswerModel;
  readonly performance: PerformanceModel;
}

/** What one simulated participant leaves behind. */
export interface SimulatedParticipant {
  readonly participant: string;
  readonly progress: Progress;
  readonly records: readonly StudyRecord[];
}

/** The plan under a name that cannot be taken for a study of people. */
export const simulatedPlan = (plan: StudyPlan): StudyPlan => ({
  ...plan,
  id: `${plan.id.slice(0, 37)}-simulated`,
  title: `SIMULATED: ${plan.title}`.slice(0, 120),
});

const oneOf = <T>(random: RandomSource, options: readonly T[]): T =>
  options[Math.floor(random.uniform() * options.length)] as T;

const drawDemographics = (random: RandomSource): Demographics => ({
  gender: oneOf(random, ['woman', 'man', 'non-binary', 'not-said']),
  age: Math.min(60, Math.max(18, Math.round(26 + 4 * random.normal()))),
  major: 'Simulated',
  vrExperience: oneOf(random, ['none', 'once-or-twice', 'several-times', 'monthly', 'weekly']),
  vrSystems: '',
  handedness: random.uniform() < 0.85 ? 'right' : 'left',
  vision: oneOf(random, ['normal', 'corrected']),
});

type GameStep = Extract<StudyStep, { kind: 'trial' | 'tutorial' }>;

/** Seconds between the starts of two participants. */
const slotSeconds = 7200;
/** Guards against a schedule that never ends. */
const mostSteps = 10_000;

/**
 * A whole study of simulated participants through the same sessions as people's, mishaps included: reloads in the middle of
 * trials, voided blocks. `at`: when the first one begins [s since 1970]. The same plan, models and seed give the same records.
 */
export function simulateStudy(
  plan: StudyPlan,
  models: SimulationModels,
  seed: number,
  at: number,
): readonly SimulatedParticipant[] {
  const { performance, answers } = models;
  const players = new Map<string, Player>(
    participantsOf(plan).map((participant) => [
      participant,
      drawPlayer(performance, randomSource(seed, `player ${participant}`)),
    ]),
  );

  /** What a trial brings; those who play together draw the same round. */
  function outcomeOf(schedule: Schedule, step: GameStep, run: number, attempt: number): TrialOutcome {
    const task = plan.tasks.find(({ id }) => id === step.task);
    const group = schedule.groups[step.task];
    if (!task || !group) throw new Error(`the plan has no task "${step.task}"`);
    const { members } = group;
    const circumstances = {
      estimator: step.estimator,
      condition: step.kind === 'trial' ? step.condition : null,
      block: step.block,
      seconds: step.seconds,
    };
    const playing = members.map((member) => players.get(member) as Player);
    if (task.game === 'archery') {
      const random = randomSource(seed, `${schedule.participant} ${step.id} ${run} ${attempt}`);
      return drawArchery(performance, players.get(schedule.participant) as Player, circumstances, random);
    }
    const random = randomSource(seed, `${members.join(' ')} ${step.id}`);
    return drawBall(performance, playing, circumstances, random)[members.indexOf(schedule.participant)] as TrialOutcome;
  }

  return participantsOf(plan).map((participant, index): SimulatedParticipant => {
    const schedule = scheduleFor(plan, participant);
    const random = randomSource(seed, `session ${participant}`);
    const person = drawPerson(answers, randomSource(seed, `person ${participant}`));
    const player = players.get(participant) as Player;
    const records: StudyRecord[] = [];
    let progress = begin(schedule, true);
    let now = at + index * slotSeconds;
    const tell = (event: ProgressEvent) => {
      const next = advance(schedule, progress, event, now);
      if (next.refusal) throw new Error(`${participant}, ${progress.step}: ${next.refusal}`);
      progress = next.progress;
      records.push(...next.records);
    };
    for (let steps = 0; steps < mostSteps; steps++) {
      const step = currentStep(schedule, progress);
      if (step.kind === 'end') return { participant, progress, records };
      now += 5 + Math.round(10 * random.uniform());
      switch (step.kind) {
        case 'consent':
          tell({ type: 'consent', version: schedule.consentVersion, motion: false });
          break;
        case 'demographics':
          tell({ type: 'demographics', demographics: drawDemographics(random) });
          break;
        case 'calibration':
          tell({ type: 'calibrated', calibration: { eyeHeight: player.eyeHeight, armSpan: player.armSpan } });
          break;
        case 'rest':
          now += step.seconds;
          tell({ type: 'tick' });
          break;
        case 'tutorial':
        case 'trial': {
          tell({ type: 'start' });
          if (random.uniform() < performance.mishaps.reload) {
            now += 10;
            progress = resumed(schedule, JSON.stringify(progress));
            tell({ type: 'reload' });
            break;
          }
          const run = progress.runs[`${step.task}/${step.block}`] ?? 1;
          const outcome = outcomeOf(schedule, step, run, progress.attempt);
          now += outcome.seconds;
          tell({ type: 'trial-finished', outcome });
          // A group's block is voided for all or none; alone, mishaps are one's own.
          const alone = schedule.groups[step.task]?.members.length === 1;
          if (step.kind === 'trial' && alone && random.uniform() < performance.mishaps.voided) {
            tell({ type: 'void-block', reason: 'simulated mishap', repeat: true });
          }
          break;
        }
        case 'questionnaire': {
          const { condition, block } = step;
          const drawn = drawAnswers(answers, questionnaires[step.questionnaire], { person, condition, block }, random);
          for (const [question, value] of Object.entries(drawn)) {
            now += 4 + Math.round(8 * random.uniform());
            tell({ type: 'answer', question, value });
          }
          tell({ type: 'submit' });
          break;
        }
      }
    }
    throw new Error(`${participant} does not come to an end`);
  });
}
