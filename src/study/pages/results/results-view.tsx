import './results.css';
import { type ReadonlySignal, type Signal, useComputed, useSignal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { type Choice, Chooser } from 'threepoint-ui/controls';
import type { StudyRecord } from '../../model/records/study-record';
import { cohortViews, hasOverallAnalysis } from '../../model/results/exported-results';
import type { Exclusion } from '../../model/results/measures';
import { studyTables } from '../../model/tables/study-tables';
import { meanSummary } from '../../statistics/summaries';
import { FrameTimes } from './frame-time-results';
import { OverallResults } from './overall-results';
import { csvButton } from './result-cells';
import { type ShownResults, type ShownStudy, shownResults } from './shown-results';
import { type ComparedPair, cohortResults, comparePair, pairResults } from './two-sided-results';

/** The ids of two sides that are compared: first − second. */
type Sides = readonly [string, string];

/** Returns the initial sides: the second entry against the first, which is the reference; null: there is only one. */
const initialSides = ([baseline, other]: readonly Choice[]): Sides | null =>
  baseline && other ? [other.id, baseline.id] : null;

interface ResultsProps {
  readonly results: ShownResults;
}

/** Everything computed from a study: figures, tables, exclusions. */
export function StudyResults({ study }: { readonly study: ShownStudy }) {
  const results = useMemo(() => shownResults(study), [study]);
  const sides = useSignal(initialSides(study.plan.conditions));
  const pair = useComputed(() => {
    if (!sides.value) return null;
    return sides.value[0] === sides.value[1] ? 'alike' : comparePair(results, sides.value);
  });
  return (
    <>
      <Summary results={results} />
      <OverallResults results={results} />
      <Conditions results={results} sides={sides} pair={pair} />
      <Cohorts results={results} />
      <FrameTimes results={results} />
      <LeftOut results={results} pair={pair} />
      <h2>Tables of the export</h2>
      <div class="bar">
        {studyTables(study.records, study.plan).map((table) =>
          csvButton(table, results.fileOf(table.name), `${table.name}.csv`),
        )}
      </div>
    </>
  );
}

function demographicsText(records: readonly StudyRecord[]): string {
  const people = records.flatMap((record) => (record.kind === 'demographics' ? [record.body] : []));
  if (people.length === 0) return 'No participant has answered the questions about themselves yet.';
  const { mean, standardDeviation } = meanSummary(people.map(({ age }) => age));
  const count = (test: (one: (typeof people)[number]) => boolean) => people.filter(test).length;
  return (
    `${people.length} people, ${mean.toFixed(1)} years old on average (SD ${(standardDeviation ?? 0).toFixed(1)}): ` +
    `${count(({ gender }) => gender === 'woman')} women, ${count(({ gender }) => gender === 'man')} men, ${count(({ gender }) => gender !== 'woman' && gender !== 'man')} others or not said; ` +
    `${count(({ handedness }) => handedness === 'right')} right-handed; ` +
    `${count(({ vision }) => vision !== 'normal')} with corrected or impaired vision; ` +
    `${count(({ vrExperience }) => vrExperience === 'none')} new to virtual reality.`
  );
}

function Summary({ results: { study, measures } }: ResultsProps) {
  const { plan, records } = study;
  const participants = new Set(records.map(({ participant }) => participant));
  return (
    <section class="card">
      <p>{`${participants.size} of ${plan.participants} participants have records. ${demographicsText(records)}`}</p>
      <p class="soft" role="note">
        {measures.planned.length === 0
          ? 'The plan names no measure as planned: everything here is exploratory.'
          : 'Planned measures come first, as a separate family. All other tables are exploratory; planned measures are marked in them.'}
      </p>
    </section>
  );
}

/** The compared conditions. null: the plan has one condition. alike: the same condition is chosen twice. */
type ChosenPair = ReadonlySignal<ComparedPair | 'alike' | null>;

interface PairProps extends ResultsProps {
  readonly sides: Signal<Sides | null>;
  readonly pair: ChosenPair;
}

function Conditions({ results, sides, pair }: PairProps) {
  const { plan } = results.study;
  if (!pair.value) return null;
  return (
    <>
      <h2>{hasOverallAnalysis(plan) ? 'Two conditions' : 'Both conditions'}</h2>
      {sidesChooser('condition', plan.conditions, sides)}
      {pair.value === 'alike' ? (
        <p class="complaint">Choose two different conditions.</p>
      ) : (
        pairResults(results, pair.value)
      )}
    </>
  );
}

function Cohorts({ results }: ResultsProps) {
  const { plan } = results.study;
  const { cohorts = [] } = plan;
  const views = cohortViews(plan).map((view) => ({
    id: view.join(' '),
    label: view.length === 1 ? results.labelOf(view[0] ?? '') : 'all conditions, the mean of each participant',
  }));
  const sides = useSignal(initialSides(cohorts));
  const under = useSignal(views[0]?.id ?? '');
  if (!sides.value) return null;
  return (
    <>
      <h2>Two cohorts</h2>
      {sidesChooser('cohort', cohorts, sides)}
      {views.length > 1 && (
        <div class="bar">
          <Chooser
            name="Under"
            choices={views}
            chosen={under.value}
            choose={(id) => {
              under.value = id;
            }}
          />
        </div>
      )}
      {sides.value[0] === sides.value[1] ? (
        <p class="complaint">Choose two different cohorts.</p>
      ) : (
        cohortResults(results, { sides: sides.value, conditions: under.value.split(' ') })
      )}
    </>
  );
}

/** Returns the choice of which two of several `what` are compared; nothing if there are only two. */
function sidesChooser(what: 'condition' | 'cohort', choices: readonly Choice[], sides: Signal<Sides | null>) {
  if (choices.length < 3 || !sides.value) return null;
  const [first, second] = sides.value;
  const choose = (...chosen: Sides) => {
    sides.value = chosen;
  };
  return (
    <div class="bar">
      <Chooser name={`Compare ${what}`} choices={choices} chosen={first} choose={(id) => choose(id, second)} />
      <Chooser name={`with ${what}`} choices={choices} chosen={second} choose={(id) => choose(first, id)} />
    </div>
  );
}

/** Returns lines such as "P03 (archery, ball): voided: the phone rang", one for each participant and reason. */
function exclusionList(all: readonly Exclusion[]): readonly string[] {
  const lines = new Map<string, { readonly participant: string; readonly reason: string; readonly of: Set<string> }>();
  for (const { participant, of, reason } of all) {
    const key = `${participant} ${reason}`;
    const line = lines.get(key) ?? { participant, reason, of: new Set<string>() };
    line.of.add(of);
    lines.set(key, line);
  }
  return [...lines.values()].map(({ participant, reason, of }) => `${participant} (${[...of].join(', ')}): ${reason}`);
}

const List = ({ lines }: { readonly lines: readonly string[] }) => (
  <ul>
    {lines.map((line) => (
      <li>{line}</li>
    ))}
  </ul>
);

function LeftOut({ results: { study, measures }, pair }: Omit<PairProps, 'sides'>) {
  const { answers, scales, points } = measures;
  const all = pair.value ?? { excluded: [...answers, ...scales, ...points].flatMap(({ voided }) => voided) };
  const excluded = all === 'alike' ? [] : exclusionList(all.excluded);
  const assisted = study.records.flatMap((record) => {
    if (record.kind !== 'trial' || record.body.outcome.assists.length === 0) return [];
    const { place, outcome } = record.body;
    return [`${record.participant}, ${place.task} block ${place.block}: ${outcome.assists.join(', ')}`];
  });
  return (
    <>
      <h2>Left out</h2>
      {excluded.length === 0 ? <p>Nothing was left out of the comparisons above.</p> : <List lines={excluded} />}
      <p class="soft">Tutorials and interrupted attempts are recorded but not evaluated.</p>
      {assisted.length > 0 && (
        <>
          <h2>Played with aids</h2>
          <List lines={assisted} />
        </>
      )}
    </>
  );
}
