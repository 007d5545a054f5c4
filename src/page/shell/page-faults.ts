import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import type { Notices } from 'threepoint-ui/notices';

/** Shows uncaught errors as notices. */
export function reportFaults(notices: Pick<Notices, 'show'>): void {
  const wentWrong = (text: string) => notices.show('error', `Something went wrong: ${firstLine(text)}`);
  window.addEventListener('error', ({ message }) => wentWrong(message));
  window.addEventListener('unhandledrejection', ({ reason }) => wentWrong(reasonOf(reason)));
}

/** Replaces a page that cannot start by its error. */
export function showStartFailure(error: unknown): void {
  const text = document.createElement('p');
  text.className = 'fault';
  text.setAttribute('role', 'alert');
  text.textContent = `threepoint cannot start: ${firstLine(reasonOf(error))}`;
  document.body.replaceChildren(text);
}
