import { element } from 'threepoint-ui/element';
import type { StudyListing } from '../model/progress/study-api';

/** The studies of a server, to choose one from; `choose` gets its id, or an empty text. `none`: what the list says without any. */
export function studySelect(
  listed: readonly StudyListing[],
  chosen: string | undefined,
  none: string,
  choose: (id: string) => void,
): HTMLSelectElement {
  const select = element(
    'select',
    { 'aria-label': 'Study' },
    element('option', { value: '' }, listed.length === 0 ? none : 'Choose a study'),
    ...listed.map(({ id, title, simulated }) => {
      const marked = simulated && !title.startsWith('SIMULATED') ? `SIMULATED: ${title}` : title;
      return element('option', { value: id, selected: chosen === id }, `${marked} (${id})`);
    }),
  );
  select.addEventListener('change', () => {
    // A page that is drawn anew leaves a list alone that has the focus.
    select.blur();
    choose(select.value);
  });
  return select;
}
