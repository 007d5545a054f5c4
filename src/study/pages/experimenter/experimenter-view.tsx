import './experimenter.css';
import { signal } from '@preact/signals';
import { pageFolder } from 'threepoint-ui';
import { Button, FileField, Tick } from 'threepoint-ui/controls';
import { studyTitle } from '../../model/plan/plan';
import { remarksOn } from '../../model/plan/plan-remarks';
import { Table } from '../table';
import { type OpenStudy, refreshedAt } from './experimenter-state';
import { download, receiptText } from './participant-actions';
import { participantColumns, participantLook, shownParticipants } from './participant-row';
import { addStudy, deleteSimulated, simulate, tryOut } from './study-actions';

/** Returns a sentence about the versions of the plan, or null if there is only one. */
function versionsText({ versions }: OpenStudy): string | null {
  const newest = versions.at(-1);
  if (!newest || versions.length < 2) return null;
  const stays = versions
    .slice(0, -1)
    .filter(({ participants }) => participants.length > 0)
    .map(({ version, participants }) => `with version ${version}: ${participants.join(', ')}`);
  return (
    `The plan was changed: version ${newest.version} is for those who begin now. ` +
    `Earlier participants stay ${stays.join('; ')}. Results and exports keep the versions apart.`
  );
}

/** An open study: heading, participants, receipts. */
export const Study = ({ study }: { readonly study: OpenStudy }) => (
  <>
    <StudyHead study={study} />
    <Table
      caption="Participants"
      columns={participantColumns(study.versions.length > 1)}
      rows={shownParticipants(study, Math.max(0, refreshedAt.value - study.receivedAt))}
      look={participantLook}
    />
    {study.receipts.length > 0 && (
      <>
        <h2>Receipts of deletions</h2>
        <ul>
          {study.receipts.map((receipt) => (
            <li>{receiptText(receipt)}</li>
          ))}
        </ul>
      </>
    )}
    <p style="margin-top:24px">
      <a href="./experimenter.html">Begin or open another study</a>
    </p>
  </>
);

function StudyHead({ study }: { readonly study: OpenStudy }) {
  const { plan, simulated, retentionUntil, versions } = study;
  const until = new Date(retentionUntil * 1000).toLocaleDateString();
  const changed = versionsText(study);
  return (
    <>
      {simulated && (
        <p class="simulated">SIMULATED: a copy to try, or a program takes part. Its data say nothing about people.</p>
      )}
      <h2>{studyTitle(plan)}</h2>
      <p class="soft">
        {`${plan.id} · ${plan.participants} participants · consent ${plan.consent.version} · deleted after ${until}`}
      </p>
      {changed && <p>{changed}</p>}
      <Remarks remarks={remarksOn(plan)} />
      <div class="bar" style="margin-top:12px">
        {versions.toReversed().map(({ version }, index) => (
          <Button
            label={versions.length > 1 ? `Export version ${version}` : 'Export all'}
            class={index === 0 ? 'primary' : ''}
            onClick={() => download({ version })}
          />
        ))}
        <a href={`./results.html?study=${plan.id}`}>Results</a>
        {simulated ? (
          <Button label="Delete this simulated study …" class="danger" onClick={() => deleteSimulated(plan.id)} />
        ) : (
          <>
            <Button label="Try it" onClick={() => tryOut(plan)} />
            <Button label="Simulate …" onClick={() => simulate(plan)} />
          </>
        )}
      </div>
    </>
  );
}

const Remarks = ({ remarks }: { readonly remarks: readonly string[] }) =>
  remarks.length > 0 && (
    <section class="remarks">
      <h3 id="before-you-begin">Before you begin</h3>
      <ul aria-labelledby="before-you-begin">
        {remarks.map((text) => (
          <li>{text}</li>
        ))}
      </ul>
    </section>
  );

/** Whether a new study is marked as simulated. */
const simulated = signal(false);

export function NewStudy() {
  const begin = (name: string, json: () => Promise<string>) =>
    void addStudy({ name, json, simulated: simulated.value });
  const paper = async () => (await fetch(`${pageFolder()}/studies/paper.json`)).text();
  return (
    <section class="card">
      <h2 style="margin-top:0">Begin a study</h2>
      <div class="bar">
        <Button label="The paper’s study" onClick={() => begin('The paper’s study', paper)} />
        <FileField
          label="Or a study file (JSON, docs/study.md)"
          name="Study file"
          accept=".json,application/json"
          open={(file) => begin(file.name, () => file.text())}
        />
        <Tick
          label="simulated: to try it, or for a program"
          checked={simulated}
          onChange={({ currentTarget }) => {
            simulated.value = currentTarget.checked;
          }}
        />
      </div>
    </section>
  );
}
