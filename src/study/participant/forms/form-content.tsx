import type { ComponentProps } from 'preact';
import { useState } from 'preact/hooks';
import { offerDownload } from 'threepoint-ui';
import { Button, Complaint } from 'threepoint-ui/controls';
import type { Phrases } from '../../model/phrases/phrases';
import { ConsentForm } from './consent-form';
import { DemographicsForm } from './demographics-form';
import { type FormOf, Heading } from './form-parts';
import type { Invited, StudyForm } from './study-form';

function ParticipantForm({ phrases: { text }, problem: asked, known, go, decline }: FormOf<'participant'>) {
  const [problem, setProblem] = useState(asked);
  const [{ participant, invitation }, setGiven] = useState<Invited>({
    participant: known.participant ?? '',
    invitation: known.invitation ?? '',
  });

  function submit(): void {
    const answer = { participant: participant.trim().toUpperCase(), invitation: invitation.trim().toUpperCase() };
    if (!/^P\d{2,3}$/.test(answer.participant)) setProblem(text('entrance.wrongCode'));
    else if (answer.invitation === '') setProblem(text('entrance.noInvitation'));
    else go(answer);
  }

  const shared = {
    type: 'text',
    autocomplete: 'off',
    onInput: ({ currentTarget: { name, value } }: { readonly currentTarget: HTMLInputElement }) =>
      setGiven({ participant, invitation, [name]: value }),
    onKeyDown: ({ key }: KeyboardEvent) => key === 'Enter' && submit(),
  } as const;
  return (
    <>
      <Heading kicker={text('study')} title={text('entrance.title')} />
      <label class="field">
        <span>{text('entrance.code')}</span>
        <input name="participant" placeholder="P01" maxLength={4} value={participant} {...shared} />
      </label>
      <label class="field">
        <span>{text('entrance.invitation')}</span>
        <input name="invitation" placeholder="XXXX-XXXX-XXXX-XXXX" maxLength={30} value={invitation} {...shared} />
      </label>
      <p class="soft">{text('consent.nothingRecorded')}</p>
      <div class="row">
        <Complaint text={problem} />
        <Button label={text('continue')} class="primary" onClick={submit} />
        <Button label={text('consent.decline')} onClick={decline} />
      </div>
    </>
  );
}

function WithdrawalForm({ phrases: { text }, code, withdrawalPage, noted, stop }: FormOf<'code'>) {
  const saved = `${text('code.file', { code, address: withdrawalPage })}\n`;
  return (
    <>
      <Heading kicker={text('code.kicker')} title={text('code.title')} />
      <p>
        <code>{code}</code>
      </p>
      <p>
        {`${text('code.use')} `}
        <a href={withdrawalPage} target="_blank" rel="noopener">
          {withdrawalPage.replace(/^https?:\/\//, '')}
        </a>
      </p>
      <p>{text('code.once')}</p>
      <div class="row">
        <Button label={text('code.noted')} class="primary" onClick={noted} />
        <Button label={text('code.save')} onClick={() => offerDownload('withdrawal-code.txt', 'text/plain', saved)} />
        <Button label={text('stopStudy')} onClick={stop} />
      </div>
    </>
  );
}

function LockedOutForm({ phrases: { text }, participant, unsent, contact, restart }: FormOf<'locked-out'>) {
  const title = text(contact === null ? 'callExperimenter' : 'lockedOut.title');
  return (
    <>
      <Heading kicker={text('study')} title={title} trouble />
      <p>{text('lockedOut.place', { participant })}</p>
      {contact !== null && <p>{text('lockedOut.contact', { contact })}</p>}
      {unsent > 0 && <p class="hint">{text('lockedOut.unsent', { count: unsent })}</p>}
      <div class="row">
        <Button label={text('lockedOut.restart')} onClick={restart} />
      </div>
    </>
  );
}

const Message = ({ text, ...heading }: ComponentProps<typeof Heading> & { readonly text: string }) => (
  <>
    <Heading {...heading} />
    <p>{text}</p>
  </>
);

/** The content of a form. `onLanguage` receives the phrases of another language that is chosen on it. */
export function formContent(form: StudyForm, onLanguage: (phrases: Phrases) => void) {
  const { text } = form.phrases;
  switch (form.kind) {
    case 'participant':
      return <ParticipantForm {...form} />;
    case 'consent':
      return <ConsentForm form={form} onLanguage={onLanguage} />;
    case 'declined':
      return <Message kicker={form.title} title={text('declined.title')} text={text('declined.text')} />;
    case 'code':
      return <WithdrawalForm {...form} />;
    case 'demographics':
      return <DemographicsForm {...form} />;
    case 'locked-out':
      return <LockedOutForm {...form} />;
    case 'fault':
      return <Message kicker={text('study')} title={text('entrance.fault')} text={form.text} trouble />;
  }
}
