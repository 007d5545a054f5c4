import 'threepoint-ui/styles/document.css';
import { reasonOf } from 'threepoint/core';
import { button, element, labelled, offerDownload, pageElement, pageFolder } from 'threepoint-ui';
import { createWithdrawalClient, ServerUnreachable } from '../../client/study-client';
import { inLanguage } from '../../model/phrases/localized-text';
import { type Phrases, phrasesOf, preferredLanguage, shippedLanguages } from '../../model/phrases/phrases';
import { Rejection } from '../../model/progress/rejection';
import type { PublicStudy, Receipt } from '../../model/progress/study-api';
import { languageChoice } from '../forms/form-parts';
import { localizedReason } from '../localized-reasons';
import { openStudyVault } from '../session/study-vault';

const client = createWithdrawalClient(pageFolder());
const content = pageElement('content', HTMLElement);
/** The study in the address; null: none. */
const asked = new URLSearchParams(location.search).get('study');

const paragraph = (text: string, attributes = {}) => element('p', attributes, text);

/** Returns a field for one line with its label. */
function field(label: string, attributes: Readonly<Record<string, string | number>>) {
  const input = element('input', { type: 'text', autocomplete: 'off', spellcheck: 'false', ...attributes });
  return { input, node: labelled(label, input) };
}

/** Deletes the data of the participant in this browser; resolves with a sentence about the result. */
async function forgottenHere(receipt: Receipt, { text }: Phrases): Promise<string> {
  try {
    const vault = await openStudyVault();
    await vault.forget(receipt);
    vault.close();
    return text('receipt.hereToo');
  } catch {
    // reason: a browser without storage holds nothing, and the sentence says what else there is to do
    return text('receipt.elsewhere');
  }
}

function receiptLines(
  { number, study, participant, records, motionFiles, at }: Receipt,
  { text, locale }: Phrases,
): readonly string[] {
  return [
    text('receipt.number', { number, study }),
    text('receipt.deleted', {
      participant,
      records: text('receipt.records', { count: records }),
      recordings: text('receipt.recordings', { count: motionFiles }),
    }),
    text('receipt.when', { time: new Date(1000 * at).toLocaleString(locale), address: pageFolder() }),
  ];
}

/** Returns the receipt that is shown after the deletion. */
function receiptCard(receipt: Receipt, about: PublicStudy | null, phrases: Phrases, here: string): HTMLElement {
  const { text } = phrases;
  const lines = receiptLines(receipt, phrases);
  const save = () =>
    offerDownload(`receipt-${receipt.study}-${receipt.number}.txt`, 'text/plain', `${lines.join('\n')}\n`);
  return element(
    'section',
    { class: 'card', 'aria-label': text('receipt.name') },
    element('h2', { style: 'margin-top:0' }, text('receipt.title')),
    ...lines.map((line) => paragraph(line)),
    paragraph(here),
    paragraph(`${text('receipt.copies')} ${about?.contact ?? text('askExperimenter')}`),
    element(
      'div',
      { class: 'bar', style: 'margin-top:12px' },
      button(text('receipt.save'), save, { class: 'primary' }),
    ),
  );
}

/** The message of the server about an unknown code. */
const unknownCode = 'nothing is recorded under this code';

/** Returns why there is no receipt. Without an answer, the server may have deleted everything nevertheless. */
function failure(error: unknown, phrases: Phrases): string {
  if (error instanceof Rejection && error.message === unknownCode) return phrases.text('withdrawal.unknownCode');
  const reason = reasonOf(error);
  return phrases.text(error instanceof ServerUnreachable ? 'withdrawal.unheard' : 'withdrawal.failed', { reason });
}

/**
 * Returns the form for the code, which deletes everything after a confirmation and shows the receipt. `about` null: the
 * server has no such study.
 */
function withdrawalForm(about: PublicStudy | null, phrases: Phrases): HTMLElement {
  const { text } = phrases;
  const study = field(text('withdrawal.study'), { name: 'study', value: asked ?? '', size: 30 });
  const code = field(text('withdrawal.code'), {
    name: 'code',
    placeholder: 'XXXX-XXXX-XXXX-XXXX',
    maxlength: 60,
    size: 30,
  });
  const sure = element('input', { type: 'checkbox' });
  const problem = paragraph('', { class: 'complaint', role: 'alert' });
  problem.hidden = true;
  const go = button(text('withdrawal.delete'), () => void withdraw(), { class: 'danger' });
  const changed = () => {
    go.disabled = !sure.checked || code.input.value.trim() === '' || study.input.value.trim() === '';
  };
  changed();
  for (const input of [study.input, code.input, sure]) input.addEventListener('input', changed);

  async function withdraw(): Promise<void> {
    go.disabled = true;
    problem.hidden = true;
    try {
      const receipt = await client.withdraw(study.input.value.trim(), code.input.value.trim());
      content.replaceChildren(receiptCard(receipt, about, phrases, await forgottenHere(receipt, phrases)));
    } catch (error) {
      problem.textContent = failure(error, phrases);
      problem.hidden = false;
      changed();
    }
  }

  return element(
    'section',
    { class: 'card' },
    ...(about ? [element('h2', { style: 'margin-top:0' }, inLanguage(about.title, phrases.language))] : []),
    paragraph(text('withdrawal.explained')),
    element('div', { class: 'bar', style: 'margin:14px 0' }, ...(about ? [] : [study.node]), code.node),
    element('label', { class: 'inline' }, sure, element('span', {}, text('withdrawal.sure'))),
    problem,
    element('div', { class: 'bar', style: 'margin-top:12px' }, go),
    element(
      'p',
      { class: 'soft', style: 'margin-top:14px' },
      text('withdrawal.lookUp'),
      ...(about?.contact ? [` ${text('withdrawal.contact', { contact: about.contact })}`] : []),
    ),
  );
}

interface Found {
  readonly about: PublicStudy | null;
  /** Why the study in the address was not found; null: it was, or the address names none. */
  readonly error: unknown;
}

async function findStudy(): Promise<Found> {
  try {
    return { about: asked === null ? null : await client.study(asked), error: null };
  } catch (error) {
    return { about: null, error };
  }
}

/** Shows the page in a language; another one can be chosen until everything is deleted. */
function show({ about, error }: Found, languages: readonly [string, ...string[]], language: string): void {
  const phrases = phrasesOf(about ?? {}, language);
  const { text, locale } = phrases;
  document.documentElement.lang = locale;
  document.title = `${text('withdrawal.title')} · threepoint`;
  pageElement('title', HTMLElement).textContent = text('withdrawal.title');
  const choice = languageChoice(languages, language, (chosen) => show({ about, error }, languages, chosen));
  choice.label(text('language'));
  const problem = error === null ? null : `“${asked}”: ${localizedReason(error, phrases)}.`;
  content.replaceChildren(
    ...(languages.length > 1 ? [element('div', { class: 'bar', style: 'margin-bottom:14px' }, choice.node)] : []),
    ...(problem === null ? [] : [paragraph(problem, { class: 'complaint', role: 'alert' })]),
    withdrawalForm(about, phrases),
  );
}

async function begin(): Promise<void> {
  const found = await findStudy();
  const languages = found.about?.languages ?? shippedLanguages;
  show(found, languages, preferredLanguage(languages, navigator.languages));
}

void begin();
