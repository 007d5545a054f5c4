import { button, element, offerDownload } from 'threepoint-ui';
import { inLanguage } from '../../model/phrases/localized-text';
import type { Phrases } from '../../model/phrases/phrases';
import { consentForm } from './consent-form';
import { demographicsForm } from './demographics-form';
import { type FormOf, heading, paragraphs, problemLine, row } from './form-parts';
import type { Invited, StudyForm } from './study-form';

function participantForm({ phrases: { text }, problem, known, go, decline }: FormOf<'participant'>): readonly Node[] {
  const line = problemLine();
  if (problem !== null) line.show(problem);
  const field = (name: keyof Invited, label: string, placeholder: string, maxlength: number) => {
    const attributes = { type: 'text', name, placeholder, maxlength, autocomplete: 'off' };
    const input = element('input', { ...attributes, value: known[name] ?? '' });
    input.addEventListener('keydown', ({ key }) => {
      if (key === 'Enter') submit.click();
    });
    return {
      value: () => input.value.trim().toUpperCase(),
      node: element('label', { class: 'field' }, element('span', {}, label), input),
    };
  };
  const participant = field('participant', text('entrance.code'), 'P01', 4);
  const invitation = field('invitation', text('entrance.invitation'), 'XXXX-XXXX-XXXX-XXXX', 30);
  const submit = button(
    text('continue'),
    () => {
      const answer = { participant: participant.value(), invitation: invitation.value() };
      if (!/^P\d{2,3}$/.test(answer.participant)) line.show(text('entrance.wrongCode'));
      else if (answer.invitation === '') line.show(text('entrance.noInvitation'));
      else go(answer);
    },
    { class: 'primary' },
  );
  return [
    ...heading(text('study'), text('entrance.title')),
    participant.node,
    invitation.node,
    line.node,
    element('p', { class: 'soft' }, text('consent.nothingRecorded')),
    row(submit, button(text('consent.decline'), decline)),
  ];
}

function withdrawalForm({ phrases: { text }, code, withdrawalPage, noted, stop }: FormOf<'code'>): readonly Node[] {
  const saved = `${text('code.file', { code, address: withdrawalPage })}\n`;
  const save = button(text('code.save'), () => offerDownload('withdrawal-code.txt', 'text/plain', saved));
  return [
    ...heading(text('code.kicker'), text('code.title')),
    element('p', {}, element('code', {}, code)),
    element(
      'p',
      {},
      `${text('code.use')} `,
      element(
        'a',
        { href: withdrawalPage, target: '_blank', rel: 'noopener' },
        withdrawalPage.replace(/^https?:\/\//, ''),
      ),
    ),
    ...paragraphs([text('code.once')]),
    row(button(text('code.noted'), noted, { class: 'primary' }), save, button(text('stopStudy'), stop)),
  ];
}

function lockedOutForm({
  phrases: { text },
  participant,
  unsent,
  contact,
  restart,
}: FormOf<'locked-out'>): readonly Node[] {
  return [
    ...heading(text('study'), contact === null ? text('callExperimenter') : text('lockedOut.title'), true),
    ...paragraphs([
      text('lockedOut.place', { participant }),
      ...(contact === null ? [] : [text('lockedOut.contact', { contact })]),
    ]),
    ...(unsent > 0 ? [element('p', { class: 'hint' }, text('lockedOut.unsent', { count: unsent }))] : []),
    row(button(text('lockedOut.restart'), restart)),
  ];
}

/** Returns the nodes of a form; `onLanguage` is called when another language is chosen on it. */
export function formNodes(form: StudyForm, onLanguage: (phrases: Phrases) => void): readonly Node[] {
  const { text } = form.phrases;
  switch (form.kind) {
    case 'participant':
      return participantForm(form);
    case 'consent':
      return consentForm(form, onLanguage);
    case 'declined':
      return [...heading(form.title, text('declined.title')), ...paragraphs([text('declined.text')])];
    case 'code':
      return withdrawalForm(form);
    case 'demographics':
      return demographicsForm(form);
    case 'locked-out':
      return lockedOutForm(form);
    case 'fault':
      return [...heading(text('study'), text('entrance.fault'), true), ...paragraphs([form.text])];
  }
}

/** Returns the small text at the foot of a form. */
export const formNote = (form: StudyForm): string =>
  form.kind === 'consent' ? `${inLanguage(form.study.title, form.phrases.language)} · ${form.participant}` : '';
