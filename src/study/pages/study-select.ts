import { element } from 'threepoint-ui/element';
import type { StudyListing } from '../model/progress/study-api';

/**
 * Returns the list of studies; `choose` receives an id or an empty text. `none` is the text of the list without any.
 */
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
    // The page does not redraw a list that has the focus.
    select.blur();
    choose(select.value);
  });
  return select;
}
