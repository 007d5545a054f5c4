import { type DemographicField, demographicFields } from '../../core/study/demographics';
import { inLanguage } from '../../core/study/words';
import { offerDownload } from '../../ui/downloads';
import { button, element } from '../../ui/element';
import type { Invited, StudyForm } from './study-form';

type FormOf<Kind extends StudyForm['kind']> = Extract<StudyForm, { kind: Kind }>;

export const paragraphs = (texts: readonly string[]) => texts.map((text) => element('p', {}, text));

/** A line that says what is wrong with a form, announced. */
function complaintLine(): { readonly node: HTMLElement; say(text: string): void } {
  const node = element('p', { class: 'hint', role: 'alert' });
  node.hidden = true;
  return {
    node,
    say(text) {
      node.hidden = false;
      node.textContent = text;
    },
  };
}

/** A choice of languages, each in its own words; `onChoice` hears of the one chosen. */
function languageChoice(languages: readonly string[], chosen: string, onChoice: (language: string) => void): Node {
  const nameOf = (language: string) => new Intl.DisplayNames([language], { type: 'language' }).of(language) ?? language;
  const select = element(
    'select',
    { name: 'language' },
    ...languages.map((one) => element('option', { value: one, lang: one, selected: one === chosen }, nameOf(one))),
  );
  select.addEventListener('change', () => onChoice(select.value));
  return element('label', { class: 'field' }, element('span', {}, 'Language'), select);
}

/** The text consented to, in the language chosen. */
function consentForm({ study: { consent, simulated, languages }, ...actions }: FormOf<'consent'>): readonly Node[] {
  let language = languages[0] ?? 'en';
  const complaint = complaintLine();
  const box = () => {
    const input = element('input', { type: 'checkbox' });
    const said = element('span', {});
    return { input, said, node: element('label', { class: 'check' }, input, said) };
  };
  const agreed = box();
  agreed.said.textContent = 'I have read this, I am old enough to decide for myself, and I want to take part.';
  const motion = consent.motion === null ? null : box();
  const title = element('h1', {});
  const texts = element('div', { class: 'content' });
  const read = () => {
    title.textContent = inLanguage(consent.title, language);
    texts.replaceChildren(...paragraphs(consent.paragraphs.map((one) => inLanguage(one, language))));
    for (const node of [title, texts, ...(motion ? [motion.said] : [])]) node.lang = language;
    if (motion && consent.motion !== null) motion.said.textContent = inLanguage(consent.motion, language);
  };
  read();
  const go = button('I agree', () => void agree(), { class: 'primary', disabled: true });
  agreed.input.addEventListener('change', () => {
    go.disabled = !agreed.input.checked;
  });
  async function agree(): Promise<void> {
    go.disabled = true;
    const chosen = languages.length > 1 ? language : null;
    const said = await actions.agree({ motion: motion?.input.checked ?? false, language: chosen });
    if (said === null) return;
    complaint.say(said);
    go.disabled = false;
  }
  const choose = (chosen: string) => {
    language = chosen;
    read();
  };
  return [
    element('p', { class: 'kicker' }, `Consent · text of ${consent.version}`),
    ...(languages.length > 1 ? [languageChoice(languages, language, choose)] : []),
    title,
    ...(simulated
      ? [element('p', { class: 'hint' }, 'This study is SIMULATED: what is recorded is marked as made by a program.')]
      : []),
    texts,
    element('div', { class: 'checks' }, agreed.node, ...(motion ? [motion.node] : [])),
    element('p', { class: 'soft' }, 'Nothing is recorded before you agree.'),
    complaint.node,
    element('div', { class: 'row' }, go, button('I do not want to take part', actions.decline)),
  ];
}

function fieldNode(field: DemographicField): { readonly node: HTMLElement; value(): string | number | undefined } {
  const must = field.id === 'vrSystems' ? [] : [element('span', { class: 'must', title: 'An answer is needed' }, ' *')];
  if (field.kind === 'choice') {
    const radios = field.options.map(({ value, label }) => {
      const input = element('input', { type: 'radio', name: field.id, value });
      return { input, node: element('label', { class: 'check' }, input, element('span', {}, label)) };
    });
    return {
      node: element(
        'fieldset',
        { 'data-field': field.id },
        element('legend', {}, field.label, ...must),
        element('div', { class: 'options' }, ...radios.map(({ node }) => node)),
      ),
      value: () => radios.find(({ input }) => input.checked)?.input.value,
    };
  }
  const input =
    field.kind === 'age'
      ? element('input', { type: 'number', name: field.id, min: field.min, max: field.max, inputmode: 'numeric' })
      : element('input', { type: 'text', name: field.id, maxlength: field.maxLength, autocomplete: 'off' });
  return {
    node: element(
      'label',
      { class: 'field', 'data-field': field.id },
      element('span', {}, field.label, ...must),
      input,
    ),
    value: () => {
      if (field.kind === 'text') return input.value.trim();
      return input.value === '' ? undefined : Number(input.value);
    },
  };
}

function demographicsForm({ done, stop }: FormOf<'demographics'>): readonly Node[] {
  const complaint = complaintLine();
  const fields = demographicFields.map((field) => ({ field, ...fieldNode(field) }));
  for (const { node } of fields) {
    node.addEventListener('input', () => {
      node.classList.remove('missing');
      if (!fields.some((other) => other.node.classList.contains('missing'))) complaint.node.hidden = true;
    });
  }
  const go = button(
    'Continue',
    () => {
      const answers = Object.fromEntries(fields.map(({ field, value }) => [field.id, value()]));
      const open = fields.filter(({ field }) => {
        const answer = answers[field.id];
        return field.id !== 'vrSystems' && (answer === undefined || answer === '');
      });
      for (const { node, field } of fields)
        node.classList.toggle(
          'missing',
          open.some((other) => other.field === field),
        );
      const [first] = open;
      if (first) {
        complaint.say('What is marked still needs an answer.');
        first.node.scrollIntoView({ block: 'center' });
        return;
      }
      const said = done(answers);
      if (said !== null) complaint.say(said);
    },
    { class: 'primary' },
  );
  return [
    element('p', { class: 'kicker' }, 'About you'),
    element('h1', {}, 'Before you play'),
    element('p', { class: 'soft' }, '* An answer is needed.'),
    ...fields.map(({ node }) => node),
    complaint.node,
    element('div', { class: 'row' }, go, button('Stop the study', stop)),
  ];
}

function participantForm({ complaint: said, known, go, decline }: FormOf<'participant'>): readonly Node[] {
  const complaint = complaintLine();
  if (said !== null) complaint.say(said);
  const field = (name: keyof Invited, label: string, placeholder: string, maxlength: number) => {
    const attributes = { type: 'text', name, placeholder, maxlength, autocomplete: 'off' };
    const input = element('input', { ...attributes, value: known[name] ?? '' });
    input.addEventListener('keydown', ({ key }) => {
      if (key === 'Enter') submit.click();
    });
    return {
      said: () => input.value.trim().toUpperCase(),
      node: element('label', { class: 'field' }, element('span', {}, label), input),
    };
  };
  const participant = field('participant', 'Your code: a P and two or three digits', 'P01', 4);
  const invitation = field('invitation', 'Your invitation: sixteen letters and digits', 'XXXX-XXXX-XXXX-XXXX', 30);
  const submit = button(
    'Continue',
    () => {
      const answer = { participant: participant.said(), invitation: invitation.said() };
      if (!/^P\d{2,3}$/.test(answer.participant))
        complaint.say('Your code is a P with two or three digits, such as P01.');
      else if (answer.invitation === '') complaint.say('Without the invitation the place cannot be taken.');
      else go(answer);
    },
    { class: 'primary' },
  );
  return [
    element('p', { class: 'kicker' }, 'Study'),
    element('h1', {}, 'Who takes part?'),
    participant.node,
    invitation.node,
    complaint.node,
    element('p', { class: 'soft' }, 'Nothing is recorded before you agree.'),
    element('div', { class: 'row' }, submit, button('I do not want to take part', decline)),
  ];
}

function withdrawalForm({ code, withdrawalPage, noted, stop }: FormOf<'code'>): readonly Node[] {
  const saved = `Withdrawal code: ${code}\nTo have everything deleted, enter it at ${withdrawalPage}\n`;
  const save = button('Save both as a file', () => offerDownload('withdrawal-code.txt', 'text/plain', saved));
  return [
    element('p', { class: 'kicker' }, 'Your withdrawal code'),
    element('h1', {}, 'Please write this down'),
    element('p', {}, element('code', {}, code)),
    element(
      'p',
      {},
      'With this code you can have everything deleted that is recorded of you, at any time and without saying why: ',
      element(
        'a',
        { href: withdrawalPage, target: '_blank', rel: 'noopener' },
        withdrawalPage.replace(/^https?:\/\//, ''),
      ),
    ),
    ...paragraphs(['It is shown only now and cannot be looked up later: note it, also if you stop here.']),
    element(
      'div',
      { class: 'row' },
      button('I have noted it', noted, { class: 'primary' }),
      save,
      button('Stop the study', stop),
    ),
  ];
}

function lockedOutForm({ participant, unsent, contact, anew }: FormOf<'locked-out'>): readonly Node[] {
  return [
    element('p', { class: 'kicker trouble' }, 'Study'),
    element('h1', {}, contact === null ? 'Please call the experimenter' : 'It does not go on here'),
    ...paragraphs([
      `${participant} was released for another device, or what was recorded was deleted. This device sends nothing more.`,
      ...(contact === null ? [] : [`Have you neither withdrawn nor gone on elsewhere? ${contact}`]),
    ]),
    ...(unsent > 0
      ? [
          element(
            'p',
            { class: 'hint' },
            `${unsent} records were never sent. Beginning anew deletes them from this device.`,
          ),
        ]
      : []),
    element('div', { class: 'row' }, button('Forget it here and begin anew', anew)),
  ];
}

/** What leads nowhere: a heading, and why. */
function lastWords(kicker: string, title: string, text: string, trouble: boolean): readonly Node[] {
  return [
    element('p', { class: trouble ? 'kicker trouble' : 'kicker' }, kicker),
    element('h1', {}, title),
    ...paragraphs([text]),
  ];
}

export function formNodes(form: StudyForm): readonly Node[] {
  switch (form.kind) {
    case 'participant':
      return participantForm(form);
    case 'consent':
      return consentForm(form);
    case 'declined':
      return lastWords(
        form.title,
        'Thank you all the same',
        'Nothing was recorded. You can close this page, or open your link again.',
        false,
      );
    case 'code':
      return withdrawalForm(form);
    case 'demographics':
      return demographicsForm(form);
    case 'locked-out':
      return lockedOutForm(form);
    case 'fault':
      return lastWords('Study', 'The study cannot go on here', form.text, true);
  }
}

/** Small, at the foot of a form. */
export const formNote = (form: StudyForm): string =>
  form.kind === 'consent' ? `${form.study.title} · ${form.participant}` : '';
