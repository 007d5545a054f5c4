import { type DemographicField, demographicFields } from '../../core/study/questionnaires';
import { button, element } from '../../ui/element';
import type { StudyScreen } from './study-screen';

/** The study on the desktop: one card over the page. */
export interface StudyCard {
  /** null hides it. */
  show(screen: StudyScreen | null): void;
  /** A form takes the card's place until the next `show` of something else; built once per id. */
  form(id: string, build: () => readonly Node[], footnote?: string): void;
}

const paragraphs = (texts: readonly string[]) => texts.map((text) => element('p', {}, text));

function questionNodes(question: NonNullable<StudyScreen['question']>): readonly Node[] {
  const dots = element('nav', { 'aria-label': 'Questions', class: 'dots' });
  for (const [index, { id, state }] of question.all.entries()) {
    const here = index + 1 === question.number;
    const words = state === 'answered' ? 'answered' : 'needs an answer';
    dots.append(
      button(String(index + 1), () => question.goTo(index), {
        'data-id': `go-${id}`,
        class: `dot ${state}`,
        'aria-label': `Question ${index + 1}, ${words}`,
        ...(here && { 'aria-current': 'step' }),
      }),
    );
  }
  const choices = question.scale.map(({ value, label }) => {
    const radio = element('input', {
      type: 'radio',
      name: question.id,
      value,
      checked: question.answer === value,
      'data-id': `answer-${value}`,
    });
    radio.addEventListener('change', () => question.choose(value));
    return element('label', { class: 'choice' }, radio, element('b', {}, String(value)), element('span', {}, label));
  });
  return [
    dots,
    element(
      'fieldset',
      { class: 'scale' },
      element('legend', {}, question.text, element('span', { class: 'must', title: 'An answer is needed' }, ' *')),
      ...choices,
    ),
  ];
}

export function createStudyCard(): StudyCard {
  const kicker = element('p', { class: 'kicker' });
  const content = element('div', { class: 'content' });
  const figure = element('p', { class: 'figure', role: 'timer', 'aria-live': 'off' });
  const bar = element('progress', { max: 1, value: 0, 'aria-label': 'Progress' });
  const hint = element('p', { class: 'hint', role: 'status' });
  const row = element('div', { class: 'row' });
  const footnote = element('p', { class: 'footnote' });
  const card = element('section', { class: 'study-card', 'aria-label': 'Study' });
  const layer = element('div', { class: 'study-layer' }, card);
  layer.hidden = true;
  document.body.append(layer);
  let shownKey = '';

  const put = (node: HTMLElement, text: string | null) => {
    node.hidden = text === null;
    if (text !== null && node.textContent !== text) node.textContent = text;
  };

  return {
    show(screen) {
      layer.hidden = screen === null;
      if (!screen) return;
      const { question, text, title, buttons } = screen;
      const key = JSON.stringify([
        screen.id,
        title,
        text,
        question,
        buttons.map(({ id, label, look }) => [id, label, look]),
      ]);
      if (key !== shownKey) {
        shownKey = key;
        const focused = document.activeElement?.getAttribute('data-id');
        const another = card.dataset.screen !== screen.id;
        card.dataset.screen = screen.id;
        content.replaceChildren(
          ...(question ? questionNodes(question) : [element('h1', {}, title), ...paragraphs(text)]),
        );
        row.replaceChildren(
          ...buttons.map(({ id, label, look, act }) =>
            button(label, act, {
              'data-id': id,
              class: look === 'primary' ? 'primary' : undefined,
              disabled: look === 'off',
            }),
          ),
        );
        card.replaceChildren(kicker, content, figure, bar, hint, row, footnote);
        // A card built anew keeps the focus of the keyboard where it was.
        const again = focused && card.querySelector<HTMLElement>(`[data-id="${focused}"]`);
        if (again) again.focus({ preventScroll: true });
        if (another) card.scrollTop = 0;
      }
      put(kicker, screen.kicker);
      kicker.classList.toggle('trouble', screen.trouble);
      put(figure, screen.figure);
      bar.hidden = screen.part === null;
      if (screen.part !== null) bar.value = screen.part;
      put(hint, screen.hint);
      put(footnote, screen.footnote);
    },
    form(id, build, note = '') {
      layer.hidden = false;
      put(footnote, note);
      if (shownKey === `form ${id}`) return;
      shownKey = `form ${id}`;
      card.dataset.screen = id;
      card.replaceChildren(...build(), footnote);
      card.scrollTop = 0;
    },
  };
}

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

/** The text consented to; `agree` answers with a complaint, or null where all went well. */
export function consentForm(
  consent: {
    readonly title: string;
    readonly version: string;
    readonly paragraphs: readonly string[];
    readonly motion: string | null;
  },
  notice: string | null,
  actions: { agree(motion: boolean): Promise<string | null>; decline(): void },
): readonly Node[] {
  const complaint = complaintLine();
  const box = (text: string) => {
    const input = element('input', { type: 'checkbox' });
    return { input, node: element('label', { class: 'check' }, input, element('span', {}, text)) };
  };
  const agreed = box('I have read this, I am old enough to decide for myself, and I want to take part.');
  const motion = consent.motion === null ? null : box(consent.motion);
  const go = button('I agree', () => void agree(), { class: 'primary', disabled: true });
  agreed.input.addEventListener('change', () => {
    go.disabled = !agreed.input.checked;
  });
  async function agree(): Promise<void> {
    go.disabled = true;
    const said = await actions.agree(motion?.input.checked ?? false);
    if (said === null) return;
    complaint.say(said);
    go.disabled = false;
  }
  return [
    element('p', { class: 'kicker' }, `Consent · text of ${consent.version}`),
    element('h1', {}, consent.title),
    ...(notice ? [element('p', { class: 'hint' }, notice)] : []),
    ...paragraphs(consent.paragraphs),
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

/** Who takes part; `done` answers with a complaint, or null. */
export function demographicsForm(done: (answers: Record<string, unknown>) => string | null): readonly Node[] {
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
    element('div', { class: 'row' }, go),
  ];
}

/** Who takes part, and what shows that they were invited. */
interface Invited {
  readonly participant: string;
  readonly invitation: string;
}

/** Asks for a participant's code and invitation, filled in as far as they are known; `go` gets both in capitals. */
export function participantForm(
  { title, complaint: said }: { readonly title: string; readonly complaint: string | null },
  known: { readonly [Part in keyof Invited]: string | null },
  go: (said: Invited) => void,
): readonly Node[] {
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
  const participant = field('participant', 'Your code, as the experimenter gave it to you', 'P01', 4);
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
    element('h1', {}, title),
    participant.node,
    invitation.node,
    complaint.node,
    element('div', { class: 'row' }, submit),
  ];
}

/** Shown once: the code with which everything can be deleted. */
export function withdrawalForm(code: string, noted: () => void): readonly Node[] {
  return [
    element('p', { class: 'kicker' }, 'Your withdrawal code'),
    element('h1', {}, 'Please write this down'),
    element('p', {}, element('code', {}, code)),
    ...paragraphs([
      'Give this code to the experimenter, and everything that was recorded under it is deleted. It is shown only now, and cannot be looked up later.',
    ]),
    element('div', { class: 'row' }, button('I have noted it', noted, { class: 'primary' })),
  ];
}

/** The place is no longer this device's: the next participant here may begin anew. */
export function lockedOutForm(participant: string, unsent: number, anew: () => void): readonly Node[] {
  return [
    element('p', { class: 'kicker trouble' }, 'Study'),
    element('h1', {}, 'Please call the experimenter'),
    ...paragraphs([
      `${participant} was released for another device, or what was recorded was deleted. This device sends nothing more.`,
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
export function lastWords(kicker: string, title: string, text: string, trouble: boolean): readonly Node[] {
  return [
    element('p', { class: trouble ? 'kicker trouble' : 'kicker' }, kicker),
    element('h1', {}, title),
    ...paragraphs([text]),
  ];
}
