import { inLanguage } from '../../model/phrases/localized-text';
import { embodimentInWords } from '../../model/plan/embodiment';
import { languagesOf, type StudyPlan, taskTitle } from '../../model/plan/plan';
import { blindLabel, type StudyStep, scheduleFor } from '../../model/plan/schedule';

/** The place of a screen; questionnaires can be answered at either. */
export type PreviewPlace = 'desk' | 'headset' | 'either';

/** One screen at which a preview stops. */
export interface PreviewStop {
  /** Unique in the plan, for addresses: "archery/1/questionnaire/Q1". */
  readonly id: string;
  readonly step: string;
  readonly kind:
    | 'consent'
    | 'code'
    | 'demographics'
    | 'enter'
    | 'measure'
    | 'measuring'
    | 'ready'
    | 'waiting'
    | 'playing'
    | 'rest'
    | 'question'
    | 'end';
  readonly at: PreviewPlace;
  /** The label in the list of stops, which names the condition for experimenters. */
  readonly label: string;
  /** The index of a question in its questionnaire; 0 for other stops. */
  readonly question: number;
}

const longestLabel = 60;
const shortened = (text: string) => (text.length > longestLabel ? `${text.slice(0, longestLabel - 1)}…` : text);

function stopsOf(plan: StudyPlan, step: StudyStep, together: number): readonly PreviewStop[] {
  const stop = (kind: PreviewStop['kind'], at: PreviewPlace, label: string, question = 0): PreviewStop => ({
    id: kind === 'question' ? `${step.id}/${label.split(':')[0]}` : `${step.id}/${kind}`,
    step: step.id,
    kind,
    at,
    label,
    question,
  });
  const title = 'task' in step ? taskTitle(plan, step.task) : '';
  switch (step.kind) {
    case 'consent':
      return [stop('consent', 'desk', 'Consent'), stop('code', 'desk', 'Withdrawal code')];
    case 'demographics':
      return [stop('demographics', 'desk', 'About you')];
    case 'calibration':
      return [
        stop('enter', 'desk', `${title}: put on the headset`),
        stop('measure', 'headset', `${title}: measures of the body`),
        stop('measuring', 'headset', `${title}: being measured`),
      ];
    case 'tutorial':
    case 'trial': {
      const what = step.kind === 'trial' ? `${blindLabel(step)}, “${step.condition}”` : 'practice';
      return [
        stop('ready', 'headset', `${title}: before ${what}`),
        ...(together > 1 ? [stop('waiting', 'headset', `${title}: waiting for the others`)] : []),
        stop(
          'playing',
          'headset',
          `${title}: ${what}, ${Math.round(step.seconds)} s as ${embodimentInWords(step.embodiment)}`,
        ),
      ];
    }
    case 'rest':
      return [stop('rest', 'either', `${title}: rest of ${Math.round(step.seconds)} s`)];
    case 'questionnaire': {
      const [language] = languagesOf(plan);
      return step.questionnaire.questions.map(({ id, text }, index) =>
        stop('question', 'either', shortened(`${id}: ${inLanguage(text, language)}`), index),
      );
    }
    case 'end':
      return [stop('end', 'either', 'Thank you')];
  }
}

/** Returns every screen of a participant in order; throws if the plan has no such participant. */
export function previewStops(plan: StudyPlan, participant: string): readonly PreviewStop[] {
  const { steps, groups } = scheduleFor(plan, participant);
  return steps.flatMap((step) => stopsOf(plan, step, 'task' in step ? (groups[step.task]?.members.length ?? 1) : 1));
}
