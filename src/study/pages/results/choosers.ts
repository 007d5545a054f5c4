import { element } from 'threepoint-ui/element';
import { bar } from './result-cells';

interface Choice {
  readonly id: string;
  readonly label: string;
}

/** Returns a list to choose one entry from. */
export function chooser(
  name: string,
  choices: readonly Choice[],
  chosen: string,
  choose: (id: string) => void,
): HTMLElement {
  const select = element(
    'select',
    { 'aria-label': name },
    ...choices.map(({ id, label }) => element('option', { value: id, selected: id === chosen }, label)),
  );
  select.addEventListener('change', () => choose(select.value));
  return element('label', {}, element('span', {}, name), select);
}

/** Returns the choice of which two of several `what` are compared; nothing if there are only two. */
export function pairChooser(
  what: 'condition' | 'cohort',
  choices: readonly Choice[],
  [first, second]: readonly [string, string],
  choose: (pair: readonly [string, string]) => void,
): readonly Node[] {
  if (choices.length < 3) return [];
  return [
    bar(
      chooser(`Compare ${what}`, choices, first, (id) => choose([id, second])),
      chooser(`with ${what}`, choices, second, (id) => choose([first, id])),
    ),
  ];
}
