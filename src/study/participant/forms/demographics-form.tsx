import { useState } from 'preact/hooks';
import { Button, Complaint } from 'threepoint-ui/controls';
import type { Phrases } from '../../model/phrases/phrases';
import { type DemographicField, demographicFields } from '../../model/records/demographics';
import { type FormOf, Heading } from './form-parts';

type Given = string | number | undefined;

const mayStayOpen = ({ id }: DemographicField) => id === 'vrSystems';

/** The control of a field with its label. `isMissing`: the answer is missing or wrong. */
function fieldContent(field: DemographicField, { text }: Phrases, isMissing: boolean) {
  const { id } = field;
  const label = [
    text(field.phrase),
    !mayStayOpen(field) && (
      <span class="must" title={text('question.needed')}>
        {' '}
        *
      </span>
    ),
  ];
  if (field.kind === 'choice') {
    return (
      <fieldset key={id} data-field={id} class={isMissing ? 'missing' : ''}>
        <legend>{label}</legend>
        <div class="options">
          {field.options.map(({ value, phrase }) => (
            <label class="check">
              <input type="radio" name={id} value={value} />
              <span>{text(phrase)}</span>
            </label>
          ))}
        </div>
      </fieldset>
    );
  }
  const attributes =
    field.kind === 'age'
      ? ({ type: 'number', min: field.min, max: field.max, inputMode: 'numeric' } as const)
      : ({ type: 'text', maxLength: field.maxLength, autocomplete: 'off' } as const);
  return (
    <label key={id} data-field={id} class={isMissing ? 'field missing' : 'field'}>
      <span>{label}</span>
      <input name={id} {...attributes} />
    </label>
  );
}

/** Returns the answer in a field; undefined: none. */
function answerIn({ id, kind }: DemographicField, given: FormData): Given {
  const value = (given.get(id) as string | null)?.trim();
  return kind === 'age' ? (value ? Number(value) : undefined) : value;
}

/** Returns what is wrong with an answer, or null. */
function problemAbout(field: DemographicField, given: Given, { text }: Phrases): string | null {
  if (given === undefined || given === '') return mayStayOpen(field) ? null : text('about.missing');
  if (field.kind !== 'age' || typeof given !== 'number') return null;
  const { min: from, max: to } = field;
  return Number.isInteger(given) && given >= from && given <= to ? null : text('about.ageRange', { from, to });
}

/** The form with the questions that the paper asked its participants before they played. */
export function DemographicsForm({ phrases, done, stop }: FormOf<'demographics'>) {
  const { text } = phrases;
  const [missing, setMissing] = useState<readonly string[]>([]);
  const [problem, setProblem] = useState<string | null>(null);

  function onInput({ target }: Event): void {
    const rest = missing.filter((id) => id !== (target as HTMLInputElement).name);
    setMissing(rest);
    if (rest.length === 0) setProblem(null);
  }

  function handIn({ currentTarget: { form } }: { readonly currentTarget: HTMLButtonElement }): void {
    const given = new FormData(form!);
    const answers = Object.fromEntries(demographicFields.map((field) => [field.id, answerIn(field, given)]));
    const wrong = demographicFields.flatMap((field) => {
      const reason = problemAbout(field, answers[field.id], phrases);
      return reason === null ? [] : [{ id: field.id, reason }];
    });
    setMissing(wrong.map(({ id }) => id));
    const [first] = wrong;
    setProblem(first ? first.reason : done(answers));
    if (first) form!.querySelector(`[data-field="${first.id}"]`)?.scrollIntoView({ block: 'center' });
  }

  return (
    <form class="content" onInput={onInput} onSubmit={(event) => event.preventDefault()}>
      <Heading kicker={text('about.kicker')} title={text('about.title')} />
      <p class="soft">{text('question.neededNote')}</p>
      {demographicFields.map((field) => fieldContent(field, phrases, missing.includes(field.id)))}
      <div class="row">
        <Complaint text={problem} />
        <Button label={text('continue')} class="primary" onClick={handIn} />
        <Button label={text('stopStudy')} onClick={stop} />
      </div>
    </form>
  );
}
