import { Labelled } from 'threepoint-ui/controls';
import type { StudyPlan } from '../../model/plan/plan';
import { askInDialog } from './input-dialog';
import type { Simulation } from './store-simulation';

/** Asks for the seed and the effects of a simulation; resolves with null if it is cancelled. */
export async function askForSimulation({
  seed,
  conditions,
  cohorts = [],
  participants,
}: StudyPlan): Promise<Simulation | null> {
  const compared = [...conditions, ...cohorts];
  const fields = await askInDialog({
    title: 'Simulate participants',
    confirm: 'Simulate',
    content: (
      <>
        <p class="soft">
          {participants} of them go through the plan to its end, in a separate study that is marked SIMULATED and can be
          deleted at once. Enter by how many points of a scale from 1 to 5 answers differ. With 0 everywhere the results
          should find nothing.
        </p>
        <div class="numbers">
          <Labelled label="Seed">
            <input type="number" name="seed" min={0} max={999_999_999} step={1} defaultValue={seed % 1_000_000_000} />
          </Labelled>
          {compared.map(({ id, label }) => (
            <Labelled label={`${label} (${id})`}>
              <input type="number" name={`effect ${id}`} min={-4} max={4} step={0.1} defaultValue={0} />
            </Labelled>
          ))}
        </div>
      </>
    ),
  });
  if (!fields) return null;
  const effects = compared.map(({ id }) => [id, Number(fields.get(`effect ${id}`))] as const);
  return {
    seed: Math.max(0, Math.floor(Number(fields.get('seed')))),
    effects: { answers: Object.fromEntries(effects.filter(([, effect]) => effect !== 0)), scores: {} },
  };
}
