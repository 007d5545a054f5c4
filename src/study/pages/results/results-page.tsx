import { signal } from '@preact/signals';
import { render } from 'preact';
import { useErrorBoundary } from 'preact/hooks';
import { reasonOf } from 'threepoint/core';
import { pageElement } from 'threepoint-ui';
import { Button, Chooser, Complaint, FileField } from 'threepoint-ui/controls';
import { studyTitle } from '../../model/plan/plan';
import {
  client,
  putIntoAddress,
  requestStudy,
  resume,
  SignIn,
  SignOutButton,
  StudyChooser,
} from '../experimenter-access';
import { openStudyFile } from '../study-file';
import { PaperCheck } from './paper-check';
import { StudyResults } from './results-view';
import type { ShownStudy } from './shown-results';

/** A study and the place that it is from. */
type SourcedStudy = ShownStudy & { readonly source: string };

const shown = signal<SourcedStudy | null>(null);
const problem = signal('');

/** Shows a study, or the reason why it cannot be read. */
async function show(read: () => Promise<SourcedStudy>): Promise<void> {
  problem.value = '';
  try {
    shown.value = await read();
  } catch (error) {
    problem.value = reasonOf(error);
  }
}

async function load(id: string, planVersion?: number): Promise<void> {
  const server = client.value;
  if (!server || !id) return;
  await show(async () => {
    const { plan, simulated, records, version, versions } = await requestStudy(server, id, planVersion);
    const several = versions.length > 1 ? { planVersion: version, versions } : {};
    return { plan, simulated, records, ...several, source: 'this server' };
  });
}

const openFile = (file: File) =>
  show(async () => {
    try {
      const study = openStudyFile(new Uint8Array(await file.arrayBuffer()));
      putIntoAddress(null);
      return { ...study, source: file.name };
    } catch (error) {
      throw new Error(`${file.name}: ${reasonOf(error)}`);
    }
  });

function SourceBar() {
  const study = shown.value;
  const file = (
    <FileField
      label="Or an export (zip), from this computer"
      name="Export of a study"
      accept=".zip,application/zip"
      open={openFile}
    />
  );
  if (!client.value) {
    return (
      <section class="card">
        <SignIn />
        <div class="bar">{file}</div>
      </section>
    );
  }
  return (
    <section class="card bar">
      <StudyChooser chosen={study?.plan.id} none="This server has no studies yet" choose={load} />
      {study && <Button label="Refresh" onClick={() => load(study.plan.id, study.planVersion)} />}
      {file}
      <SignOutButton />
    </section>
  );
}

const Problem = () => <Complaint text={problem.value} />;

function Results() {
  const study = shown.value;
  if (!study) return null;
  const { plan, planVersion, source } = study;
  return (
    <>
      <h2>{studyTitle(plan)}</h2>
      <p class="soft">
        {`${plan.id}${planVersion === undefined ? '' : `, version ${planVersion} of its plan`}, from ${source}.`}
      </p>
      <ComputedResults key={study} study={study} />
    </>
  );
}

function ComputedResults({ study }: { readonly study: ShownStudy }) {
  const [problem] = useErrorBoundary();
  if (problem) return <Complaint text={reasonOf(problem)} />;
  return (
    <>
      <VersionBar {...study} />
      {study.simulated && (
        <p class="simulated" role="note">
          SIMULATED: a program made these data. They say nothing about people.
        </p>
      )}
      {study.records.some(({ kind }) => kind === 'answers' || kind === 'trial') ? (
        <StudyResults study={study} />
      ) : (
        <p class="card">Nothing has been answered or played yet.</p>
      )}
    </>
  );
}

/** The choice of a version, for a plan that was changed. */
function VersionBar({ plan, planVersion, versions = [] }: ShownStudy) {
  // An export holds one version only.
  if (planVersion === undefined || versions.length === 0) return null;
  const choices = versions.map(({ version, participants }) => ({
    id: String(version),
    label: `Version ${version}: ${participants.length} participants`,
  }));
  return (
    <div class="bar">
      <Chooser
        name="Version of the plan"
        choices={choices}
        chosen={String(planVersion)}
        choose={(version) => load(plan.id, Number(version))}
      />
      <p class="soft">The plan was changed while the study ran. The results below are of one version only.</p>
    </div>
  );
}

render(
  <>
    <SourceBar />
    <Problem />
    <Results />
    <PaperCheck />
  </>,
  pageElement('content', HTMLElement),
);
resume(load);
