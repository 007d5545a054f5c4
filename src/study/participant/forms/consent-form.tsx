import { useState } from 'preact/hooks';
import { Button, Complaint } from 'threepoint-ui/controls';
import { inLanguage } from '../../model/phrases/localized-text';
import { type Phrases, phrasesOf } from '../../model/phrases/phrases';
import { type FormOf, LanguageChoice } from './form-parts';

interface ConsentFormProps {
  readonly form: FormOf<'consent'>;
  /** Receives the phrases of another language that is chosen. */
  readonly onLanguage: (phrases: Phrases) => void;
}

const box = (text: string, set: (checked: boolean) => void, lang?: string) => (
  <label class="check">
    <input type="checkbox" onChange={({ currentTarget }) => set(currentTarget.checked)} />
    <span lang={lang}>{text}</span>
  </label>
);

/** The form of consent in the chosen language. */
export function ConsentForm({ form, onLanguage }: ConsentFormProps) {
  const { consent, simulated, languages } = form.study;
  const [phrases, setPhrases] = useState(() => phrasesOf(form.study, form.language));
  const [problem, setProblem] = useState<string | null>(null);
  const [agreed, setAgreed] = useState(false);
  const [motion, setMotion] = useState(false);
  const [isSending, setSending] = useState(false);
  const { language, text } = phrases;

  function choose(chosen: string): void {
    const others = phrasesOf(form.study, chosen);
    setPhrases(others);
    setProblem(null);
    onLanguage(others);
  }

  async function agree(): Promise<void> {
    setSending(true);
    const rejection = await form.agree({ motion, language: languages.length > 1 ? language : null });
    if (rejection === null) return;
    setProblem(rejection);
    setSending(false);
  }

  return (
    <>
      <p class="kicker">{text('consent.kicker', { version: consent.version })}</p>
      <LanguageChoice label={text('language')} languages={languages} chosen={language} choose={choose} />
      <h1 lang={language}>{inLanguage(consent.title, language)}</h1>
      {simulated && <p class="hint">{text('consent.simulated')}</p>}
      <div class="content" lang={language}>
        {consent.paragraphs.map((paragraph) => (
          <p>{inLanguage(paragraph, language)}</p>
        ))}
      </div>
      <div class="checks">
        {box(text('consent.understood'), setAgreed)}
        {consent.motion !== null && box(inLanguage(consent.motion, language), setMotion, language)}
      </div>
      <p class="soft">{text('consent.nothingRecorded')}</p>
      <div class="row">
        <Complaint text={problem} />
        <Button
          label={text('consent.agree')}
          class="primary"
          disabled={!agreed || isSending}
          onClick={() => void agree()}
        />
        <Button label={text('consent.decline')} onClick={() => form.decline(phrases)} />
      </div>
    </>
  );
}
