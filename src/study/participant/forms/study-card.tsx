import { type ComponentChild, render } from 'preact';
import { useState } from 'preact/hooks';
import { Button } from 'threepoint-ui/controls';
import { inLanguage } from '../../model/phrases/localized-text';
import { questionView } from '../questions/question-views';
import type { ScreenQuestion, StudyScreen } from '../questions/study-screen';
import { formContent } from './form-content';
import type { StudyForm } from './study-form';

const phraseOfState = {
  answered: 'question.answered',
  open: 'question.open',
  missing: 'question.open',
  optional: 'question.optional',
} as const;

/** A button for each question in order. */
const Dots = ({ phrases, all, number, goTo }: ScreenQuestion) => (
  <nav class="dots" aria-label={phrases.text('question.all')}>
    {all.map(({ state }, index) => (
      <Button
        label={String(index + 1)}
        class={`dot ${state}`}
        aria-label={phrases.text(phraseOfState[state], { number: index + 1 })}
        aria-current={index + 1 === number ? 'step' : undefined}
        onClick={() => goTo(index)}
      />
    ))}
  </nav>
);

const Question = ({ id, text, language, optional, field, phrases }: ScreenQuestion) => (
  <fieldset class="scale" lang={language}>
    <legend>
      {text}
      {optional ? (
        <span class="soft" lang={phrases.locale}>
          {` ${phrases.text('question.mayStayOpen')}`}
        </span>
      ) : (
        <span class="must" lang={phrases.locale} title={phrases.text('question.needed')}>
          {' '}
          *
        </span>
      )}
    </legend>
    {questionView(field).card(field, id, phrases)}
  </fieldset>
);

function Screen({ screen }: { readonly screen: StudyScreen }) {
  const { question, part, figure, hint, phrases } = screen;
  return (
    <section class="study-card" data-screen={screen.id} lang={phrases.locale} aria-label={phrases.text('study')}>
      <p class={screen.trouble ? 'kicker trouble' : 'kicker'}>{screen.kicker}</p>
      <div class="content">
        {question ? (
          <>
            <Dots {...question} />
            <Question {...question} />
          </>
        ) : (
          <>
            <h1>{screen.title}</h1>
            {screen.text.map((text) => (
              <p>{text}</p>
            ))}
          </>
        )}
      </div>
      <p class="figure" role="timer" aria-live="off" hidden={figure === null}>
        {figure}
      </p>
      {part !== null && <progress max={1} value={part} aria-label={phrases.text('progress')} />}
      <p class="hint" role="status" hidden={hint === null}>
        {hint}
      </p>
      <div class="row">
        {screen.buttons.map(({ id, label, look, act }) => (
          <Button
            key={id}
            label={label}
            class={look === 'primary' ? 'primary' : ''}
            disabled={look === 'off'}
            onClick={act}
          />
        ))}
      </div>
      <p class="footnote">{screen.footnote}</p>
    </section>
  );
}

function Form({ form }: { readonly form: StudyForm }) {
  const [chosen, setChosen] = useState(form.phrases);
  return (
    <section class="study-card" data-screen={form.kind} lang={chosen.locale} aria-label={chosen.text('study')}>
      {formContent(form, setChosen)}
      <p class="footnote">
        {form.kind === 'consent' && `${inLanguage(form.study.title, form.phrases.language)} · ${form.participant}`}
      </p>
    </section>
  );
}

export type StudyCard = ReturnType<typeof createStudyCard>;

/** Returns the card of the study over the page on the desktop. */
export function createStudyCard() {
  const layer = document.body.appendChild(document.createElement('div'));
  layer.className = 'study-layer';
  layer.hidden = true;
  let shown: string | null = null;

  /** `name`: the name of the content, which is rebuilt for another name; null: nothing is shown. */
  function show(name: string | null, content: ComponentChild): void {
    const hadFocus = layer.contains(document.activeElement);
    layer.hidden = name === null;
    render(content, layer);
    if (name === shown) return;
    shown = name;
    // The keyboard focus moves to the new heading, which screen readers read out.
    const words = hadFocus ? layer.querySelector<HTMLElement>('h1, legend') : null;
    if (!words) return;
    words.tabIndex = -1;
    words.focus({ preventScroll: true });
  }

  return {
    /** null hides it. */
    show: (screen: StudyScreen | null) =>
      show(screen?.id ?? null, screen && <Screen key={screen.id} screen={screen} />),
    /** Shows a form instead of a screen. What is typed stays until something else is shown. */
    ask: (form: StudyForm) => show(`form ${form.kind}`, <Form key={`form ${form.kind}`} form={form} />),
  };
}
