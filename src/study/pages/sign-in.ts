import { button, element } from 'threepoint-ui/element';

/**
 * The key under which the session storage keeps the token while the tab is open. It is not kept longer, because
 * computers are shared.
 */
const kept = 'threepoint-experimenter-token';

export const keptToken = (): string | null => sessionStorage.getItem(kept);
export const forgetToken = (): void => sessionStorage.removeItem(kept);

/** Asks for the experimenter's token; `use` resolves with a complaint, or with null if the token is accepted. */
export function signInForm(use: (token: string) => Promise<string | null>): HTMLElement {
  const input = element('input', {
    type: 'password',
    name: 'token',
    autocomplete: 'off',
    'aria-label': 'Token',
    size: 40,
  });
  const complaint = element('p', { class: 'complaint', role: 'alert' });
  complaint.hidden = true;
  const go = button('Open', () => void open(), { class: 'primary' });
  async function open(): Promise<void> {
    const token = input.value.trim();
    if (!token) return;
    go.disabled = true;
    const refusal = await use(token);
    go.disabled = false;
    complaint.hidden = refusal === null;
    complaint.textContent = refusal ?? '';
    if (refusal === null) sessionStorage.setItem(kept, token);
  }
  input.addEventListener('keydown', ({ key }) => {
    if (key === 'Enter') void open();
  });
  return element(
    'div',
    { class: 'sign-in' },
    element('label', {}, element('span', {}, 'The experimenter’s token'), input),
    go,
    element('p', { class: 'soft' }, 'The server generates it at its first start and prints the path of its file.'),
    complaint,
  );
}
