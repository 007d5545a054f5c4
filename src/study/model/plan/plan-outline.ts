import { inLanguage } from '../phrases/localized-text';
import { questionKind } from '../questionnaires/question-kinds';
import type { Question } from '../questionnaires/questionnaire-schema';
import { languagesOf, type StudyPlan, taskTitle } from './plan';
import { blindLabel, type StudyStep, scheduleFor } from './schedule';

export interface OutlinedScreen {
  /** The step of the schedule: "archery/1/questionnaire". */
  readonly step: string;
  readonly shows: string;
  /** The place of the screen; questionnaires can be answered at either. */
  readonly at: 'desk' | 'headset' | 'either';
  /** The time limit in the plan; null: none. */
  readonly seconds: number | null;
}

const formInWords = ({ answer: form, optional }: Question): string => {
  const range = questionKind(form).range(form);
  return `${form.kind}${range ? ` ${range[0]} to ${range[1]}` : ''}${optional ? ', optional' : ''}`;
};

function screensOf(plan: StudyPlan, step: StudyStep): readonly OutlinedScreen[] {
  const at = (shows: string, where: OutlinedScreen['at'], seconds: number | null = null): OutlinedScreen => ({
    step: step.id,
    shows,
    at: where,
    seconds,
  });
  const title = 'task' in step ? taskTitle(plan, step.task) : '';
  switch (step.kind) {
    case 'consent':
      return [
        at(`Consent: ${inLanguage(plan.consent.title, languagesOf(plan)[0])}`, 'desk'),
        at('Withdrawal code', 'desk'),
      ];
    case 'demographics':
      return [at('About you', 'desk')];
    case 'calibration':
      return [
        ...(plan.remote
          ? [
              at(
                `${title}: what is wrong with device, room (${plan.remote.freeSpace} m) or height, if anything`,
                'either',
              ),
            ]
          : []),
        at(`${title}: measures of the body`, 'headset'),
      ];
    case 'tutorial':
      return [at(`${title}: practice with ${step.embodiment.estimator}`, 'headset', step.seconds)];
    case 'trial':
      return [at(`${title}, ${blindLabel(step)}: played under "${step.condition}"`, 'headset', step.seconds)];
    case 'rest':
      return [at(`${title}: rest`, 'headset', step.seconds)];
    case 'questionnaire': {
      const [language] = languagesOf(plan);
      const { questions } = step.questionnaire;
      const each = questions.map((question, index) =>
        at(
          `${index + 1} of ${questions.length}, ${question.id} (${formInWords(question)}): ${inLanguage(question.text, language)}`,
          'either',
        ),
      );
      const heading = `${title}, ${blindLabel(step)}: questionnaire "${step.questionnaire.id}"`;
      const limits = (plan.askToStop ?? []).filter(({ questionnaire }) => questionnaire === step.questionnaire.id);
      const unwell = limits.map(({ measure, atLeast }) => `"${measure}" from ${atLeast} on`).join(' or ');
      return [
        at(heading, 'either', step.seconds),
        ...each,
        ...(unwell === '' ? [] : [at(`How are you? Go on, or stop: for ${unwell}`, 'either')]),
      ];
    }
    case 'end':
      return [at('Thank you', 'either')];
  }
}

/** Returns every screen of a participant in order; throws if the plan has no such participant. */
export const outlineOf = (plan: StudyPlan, participant: string): readonly OutlinedScreen[] =>
  scheduleFor(plan, participant).steps.flatMap((step) => screensOf(plan, step));

/** The most that a participant takes [s], without steps that have no limit: consent, measures, demographics. */
export interface PlanDuration {
  readonly played: number;
  readonly rests: number;
  /** The sum of the time limits of all questionnaires. */
  readonly questionnaires: number;
}

/** Returns the duration, which is equal for all participants because they differ in the order only. */
export function durationOf(plan: StudyPlan): PlanDuration {
  const total = { played: 0, rests: 0, questionnaires: 0 };
  for (const step of scheduleFor(plan, plan.participants > 99 ? 'P001' : 'P01').steps) {
    if (step.kind === 'trial' || step.kind === 'tutorial') total.played += step.seconds;
    else if (step.kind === 'rest') total.rests += step.seconds;
    else if (step.kind === 'questionnaire') total.questionnaires += step.seconds;
  }
  return total;
}
