import { button, element, labelled } from 'threepoint-ui';
import type { StudyPlan } from '../../model/plan/plan';
import { askInDialog } from './input-dialog';
import type { Simulation } from './store-simulation';

function numberField(label: string, attributes: Record<string, string | number>) {
  const input = element('input', { type: 'number', ...attributes });
  return { input, node: labelled(label, input) };
}

/** Asks for the seed and the effects of a simulation; resolves with null if it is cancelled. */
export function askForSimulation({
  seed,
  conditions,
  cohorts = [],
  participants,
}: StudyPlan): Promise<Simulation | null> {
  const seedField = numberField('Seed', { min: 0, max: 999_999_999, step: 1, value: seed % 1_000_000_000 });
  const effects = [...conditions, ...cohorts].map(({ id, label }) => ({
    id,
    ...numberField(`${label} (${id})`, { min: -4, max: 4, step: 0.1, value: 0 }),
  }));
  const stated = (): Simulation => ({
    seed: Math.max(0, Math.floor(seedField.input.valueAsNumber || 0)),
    effects: {
      answers: Object.fromEntries(
        effects.flatMap(({ id, input }) => (input.valueAsNumber ? [[id, input.valueAsNumber] as const] : [])),
      ),
      scores: {},
    },
  });
  const text =
    `${participants} of them go through the plan to its end, in a separate study that is marked SIMULATED and can be deleted at once. ` +
    'Enter by how many points of a scale from 1 to 5 answers differ. With 0 everywhere the results should find nothing.';
  return askInDialog<Simulation>('Simulate participants', (answer) => ({
    content: [
      element('p', { class: 'soft' }, text),
      element('div', { class: 'numbers' }, seedField.node, ...effects.map(({ node }) => node)),
    ],
    confirm: button('Simulate', () => answer(stated()), { class: 'primary' }),
  }));
}
