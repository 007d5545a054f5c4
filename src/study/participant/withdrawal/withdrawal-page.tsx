import { render } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import { reasonOf } from 'threepoint/core';
import { offerDownload, pageElement, pageFolder } from 'threepoint-ui';
import { Button, Complaint, Labelled, Tick } from 'threepoint-ui/controls';
import { createWithdrawalClient, ServerUnreachable } from '../../client/study-client';
import { inLanguage } from '../../model/phrases/localized-text';
import { type Phrases, phrasesOf, preferredLanguage, shippedLanguages } from '../../model/phrases/phrases';
import { Rejection } from '../../model/progress/rejection';
import type { PublicStudy, Receipt } from '../../model/progress/study-api';
import { LanguageChoice } from '../forms/form-parts';
import { localizedReason } from '../localized-reasons';
import { openStudyVault } from '../session/study-vault';

const client = createWithdrawalClient(pageFolder());
/** The study in the address; null: none. */
const asked = new URLSearchParams(location.search).get('study');

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

interface DeletedProps {
  readonly receipt: Receipt;
  readonly phrases: Phrases;
  readonly title: string;
  /** Sentences about the data in this browser, and about copies. */
  readonly remarks: readonly string[];
}

/** The receipt that is shown after the deletion. */
function Deleted({ receipt, phrases, title, remarks }: DeletedProps) {
  const { text } = phrases;
  const lines = receiptLines(receipt, phrases);
  const save = () =>
    offerDownload(`receipt-${receipt.study}-${receipt.number}.txt`, 'text/plain', `${lines.join('\n')}\n`);
  return (
    <section class="card" aria-label={text('receipt.name')}>
      <h2 style="margin-top:0">{title}</h2>
      {[...lines, ...remarks].map((line) => (
        <p>{line}</p>
      ))}
      <div class="bar" style="margin-top:12px">
        <Button label={text('receipt.save')} class="primary" onClick={save} />
      </div>
    </section>
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

interface WithdrawalFormProps extends Pick<DeletedProps, 'phrases'> {
  readonly about: PublicStudy | null;
  readonly onDeleted: (deleted: DeletedProps) => void;
}

/** The form for the code, which deletes the recorded movements, or everything after a confirmation. */
function WithdrawalForm({ about, phrases, onDeleted }: WithdrawalFormProps) {
  const { text } = phrases;
  const [isComplete, setComplete] = useState(false);
  const [hasCode, setHasCode] = useState(false);
  const [isSending, setSending] = useState(false);
  const [problem, setProblem] = useState<string | null>(null);
  const shared = { autocomplete: 'off', spellcheck: false, size: 30, required: true, pattern: '.*\\S.*' };

  const copies = `${text('receipt.copies')} ${about?.contact ?? text('askExperimenter')}`;

  async function withdraw(form: HTMLFormElement, only?: 'motion'): Promise<void> {
    const given = new FormData(form);
    setSending(true);
    setProblem(null);
    try {
      const study = String(given.get('study') ?? asked).trim();
      const receipt = await client.withdraw(study, String(given.get('code')).trim(), only);
      const [title, here] = only
        ? [text('receipt.motionTitle'), text('receipt.motionKept')]
        : [text('receipt.title'), await forgottenHere(receipt, phrases)];
      onDeleted({ receipt, phrases, title, remarks: [here, copies] });
    } catch (error) {
      setProblem(failure(error, phrases));
      setSending(false);
    }
  }

  return (
    <form
      class="card"
      onInput={({ currentTarget }) => {
        setComplete(currentTarget.checkValidity());
        setHasCode([...currentTarget.querySelectorAll('input[type=text]')].every((input) => input.matches(':valid')));
      }}
      onSubmit={(event) => event.preventDefault()}
    >
      {about && <h2 style="margin-top:0">{inLanguage(about.title, phrases.language)}</h2>}
      <p>{text('withdrawal.explained')}</p>
      <div class="bar" style="margin:14px 0">
        {!about && (
          <Labelled label={text('withdrawal.study')}>
            <input type="text" {...shared} name="study" defaultValue={asked ?? ''} />
          </Labelled>
        )}
        <Labelled label={text('withdrawal.code')}>
          <input type="text" {...shared} name="code" placeholder="XXXX-XXXX-XXXX-XXXX" maxLength={60} />
        </Labelled>
      </div>
      <Tick label={text('withdrawal.sure')} required />
      <Complaint text={problem} />
      <div class="bar" style="margin-top:12px">
        <Button
          label={text('withdrawal.delete')}
          class="danger"
          disabled={isSending || !isComplete}
          onClick={({ currentTarget: { form } }) => void withdraw(form!)}
        />
        <Button
          label={text('withdrawal.motionOnly')}
          disabled={isSending || !hasCode}
          onClick={({ currentTarget: { form } }) => void withdraw(form!, 'motion')}
        />
      </div>
      <p class="soft" style="margin-top:14px">
        {text('withdrawal.lookUp')}
        {about?.contact && ` ${text('withdrawal.contact', { contact: about.contact })}`}
      </p>
    </form>
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

/** The page in a language; another one can be chosen until everything is deleted. */
function WithdrawalPage({ about, error }: Found) {
  const languages = about?.languages ?? shippedLanguages;
  const [language, choose] = useState(preferredLanguage(languages, navigator.languages));
  const [deleted, setDeleted] = useState<DeletedProps | null>(null);
  const phrases = phrasesOf(about ?? {}, language);
  const { text, locale } = phrases;
  useLayoutEffect(() => {
    document.documentElement.lang = locale;
    document.title = `${text('withdrawal.title')} · threepoint`;
    pageElement('title', HTMLElement).textContent = text('withdrawal.title');
  }, [locale]);
  if (deleted) return <Deleted {...deleted} />;
  return (
    <>
      <div class="bar" style="margin-bottom:14px" hidden={languages.length === 1}>
        <LanguageChoice label={text('language')} languages={languages} chosen={language} choose={choose} />
      </div>
      {error !== null && <Complaint text={`“${asked}”: ${localizedReason(error, phrases)}.`} />}
      <WithdrawalForm about={about} phrases={phrases} onDeleted={setDeleted} />
    </>
  );
}

void findStudy().then((found) => render(<WithdrawalPage {...found} />, pageElement('content', HTMLElement)));
