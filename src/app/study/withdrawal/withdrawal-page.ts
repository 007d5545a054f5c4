import '../../../styles/document.css';
import { reasonOf } from '../../../core/errors/reasons';
import type { PublicStudy, Receipt } from '../../../core/study/study-api';
import { createWithdrawalClient } from '../../../net/study-client';
import { offerDownload } from '../../../ui/downloads';
import { button, element, pageElement } from '../../../ui/element';
import { pageFolder } from '../../../ui/page-folder';
import { counted } from '../../../ui/phrases';
import { openStudyVault } from '../study-vault';

const client = createWithdrawalClient(pageFolder());

const paragraph = (text: string, attributes = {}) => element('p', attributes, text);

/** A field for one line, with what stands over it. */
function field(label: string, attributes: Readonly<Record<string, string | number>>) {
  const input = element('input', { type: 'text', autocomplete: 'off', spellcheck: 'false', ...attributes });
  return { input, node: element('label', {}, element('span', {}, label), input) };
}

/** What this browser still holds of the participant goes too; a sentence where it could not. */
async function forgottenHere({ study, participant }: Receipt): Promise<string> {
  try {
    const vault = await openStudyVault();
    await vault.forget(study, participant);
    vault.close();
    return 'So is what this browser still held. On another device that you used, open your link: it offers to forget what is left there.';
  } catch {
    // reason: a browser without storage holds nothing, and the sentence says what else there is to do
    return 'Where you took part on another device, open your link there: it offers to forget what is left.';
  }
}

const receiptLines = ({ number, study, participant, records, motionFiles, at }: Receipt): readonly string[] => [
  `Receipt ${number} of the study “${study}”`,
  `Deleted of ${participant}: ${counted(records, 'record')}, ${counted(motionFiles, 'recording')} of movements`,
  `${new Date(1000 * at).toLocaleString()}, by the withdrawal code, at ${pageFolder()}`,
];

/** What is left when everything is deleted. */
function receiptCard(receipt: Receipt, about: PublicStudy | null, here: string): HTMLElement {
  const lines = receiptLines(receipt);
  const save = () =>
    offerDownload(`receipt-${receipt.study}-${receipt.number}.txt`, 'text/plain', `${lines.join('\n')}\n`);
  const others =
    'Copies that were handed on before are no longer on this server: with the number of this receipt you can have them deleted too.';
  return element(
    'section',
    { class: 'card', 'aria-label': 'Receipt' },
    element('h2', { style: 'margin-top:0' }, 'Everything is deleted'),
    ...lines.map((line) => paragraph(line)),
    paragraph(here),
    paragraph(about?.contact ? `${others} ${about.contact}` : `${others} Ask the experimenter.`),
    element('div', { class: 'bar', style: 'margin-top:12px' }, button('Save the receipt', save, { class: 'primary' })),
  );
}

/** Asks for the code, and deletes once it is confirmed. `asked`: the study that the address names, null: none. */
function withdrawalForm(
  asked: string | null,
  about: PublicStudy | null,
  done: (card: HTMLElement) => void,
): HTMLElement {
  const study = field('The study, as it stands in your link', { name: 'study', value: asked ?? '', size: 30 });
  const code = field('Your withdrawal code', {
    name: 'code',
    placeholder: 'XXXX-XXXX-XXXX-XXXX',
    maxlength: 60,
    size: 30,
  });
  const sure = element('input', { type: 'checkbox' });
  const complaint = paragraph('', { class: 'complaint', role: 'alert' });
  complaint.hidden = true;
  const go = button('Delete everything', () => void withdraw(), { class: 'danger' });
  const changed = () => {
    go.disabled = !sure.checked || code.input.value.trim() === '' || study.input.value.trim() === '';
  };
  changed();
  for (const input of [study.input, code.input, sure]) input.addEventListener('input', changed);

  async function withdraw(): Promise<void> {
    go.disabled = true;
    complaint.hidden = true;
    try {
      const receipt = await client.withdraw(study.input.value.trim(), code.input.value.trim());
      done(receiptCard(receipt, about, await forgottenHere(receipt)));
    } catch (error) {
      complaint.textContent = `Nothing was deleted: ${reasonOf(error)}.`;
      complaint.hidden = false;
      changed();
    }
  }

  return element(
    'section',
    { class: 'card' },
    ...(about ? [element('h2', { style: 'margin-top:0' }, about.title)] : []),
    paragraph(
      'Everything that was recorded of you in this study is deleted at once: answers, results, movements, where you stopped. What stays is a receipt that says when how much was deleted. You need not say why. It cannot be undone, and your place is not given to you again.',
    ),
    element('div', { class: 'bar', style: 'margin:14px 0' }, ...(about ? [] : [study.node]), code.node),
    element(
      'label',
      { class: 'inline' },
      sure,
      element('span', {}, 'I want everything deleted that is recorded of me.'),
    ),
    complaint,
    element('div', { class: 'bar', style: 'margin-top:12px' }, go),
    element(
      'p',
      { class: 'soft', style: 'margin-top:14px' },
      'The code was shown to you after you agreed to take part; no one can look it up.',
      ...(about?.contact ? [` Does something not work? ${about.contact}`] : []),
    ),
  );
}

const content = pageElement('content', HTMLElement);
const asked = new URLSearchParams(location.search).get('study');

async function show(): Promise<void> {
  let about: PublicStudy | null = null;
  let complaint = '';
  try {
    if (asked !== null) about = await client.study(asked);
  } catch (error) {
    complaint = `“${asked}”: ${reasonOf(error)}.`;
  }
  content.replaceChildren(
    ...(complaint ? [paragraph(complaint, { class: 'complaint', role: 'alert' })] : []),
    withdrawalForm(asked, about, (card) => content.replaceChildren(card)),
  );
}

void show();
