import { button, element } from 'threepoint-ui';
import { inLanguage } from '../../model/phrases/localized-text';
import { type Phrases, phrasesOf } from '../../model/phrases/phrases';
import { type FormOf, languageChoice, paragraphs, problemLine, row } from './form-parts';

function box() {
  const input = element('input', { type: 'checkbox' });
  const label = element('span', {});
  return { input, label, node: element('label', { class: 'check' }, input, label) };
}

/** Returns the form of consent in the chosen language; `onLanguage` is called with the phrases of another one. */
export function consentForm(
  { study, language: first, ...actions }: FormOf<'consent'>,
  onLanguage: (phrases: Phrases) => void,
): readonly Node[] {
  const { consent, simulated, languages } = study;
  let phrases = phrasesOf(study, first);
  const problem = problemLine();
  const agreed = box();
  const motion = consent.motion === null ? null : box();
  const title = element('h1', {});
  const texts = element('div', { class: 'content' });
  const kicker = element('p', { class: 'kicker' });
  const simulation = element('p', { class: 'hint' });
  const note = element('p', { class: 'soft' });
  const go = button('', () => void agree(), { class: 'primary', disabled: true });
  const decline = button('', () => actions.decline(phrases));
  const choice = languageChoice(languages, first, (language) => {
    phrases = phrasesOf(study, language);
    problem.hide();
    onLanguage(phrases);
    showTexts();
  });

  function showTexts(): void {
    const { language, text } = phrases;
    choice.label(text('language'));
    kicker.textContent = text('consent.kicker', { version: consent.version });
    simulation.textContent = text('consent.simulated');
    agreed.label.textContent = text('consent.understood');
    note.textContent = text('consent.nothingRecorded');
    go.textContent = text('consent.agree');
    decline.textContent = text('consent.decline');
    title.textContent = inLanguage(consent.title, language);
    texts.replaceChildren(...paragraphs(consent.paragraphs.map((one) => inLanguage(one, language))));
    for (const node of [title, texts, ...(motion ? [motion.label] : [])]) node.lang = language;
    if (motion && consent.motion !== null) motion.label.textContent = inLanguage(consent.motion, language);
  }

  async function agree(): Promise<void> {
    go.disabled = true;
    const chosen = languages.length > 1 ? phrases.language : null;
    const rejection = await actions.agree({ motion: motion?.input.checked ?? false, language: chosen });
    if (rejection === null) return;
    problem.show(rejection);
    go.disabled = false;
  }

  agreed.input.addEventListener('change', () => {
    go.disabled = !agreed.input.checked;
  });
  showTexts();
  return [
    kicker,
    ...(languages.length > 1 ? [choice.node] : []),
    title,
    ...(simulated ? [simulation] : []),
    texts,
    element('div', { class: 'checks' }, agreed.node, ...(motion ? [motion.node] : [])),
    note,
    problem.node,
    row(go, decline),
  ];
}
