import { render } from 'preact';
import { pageElement } from 'threepoint-ui';
import { client, resume, SignIn, SignOutButton, StudyChooser } from '../experimenter-access';
import { notice, online, openStudy, problem, refresh, study } from './experimenter-state';
import { NewStudy, Study } from './experimenter-view';

/** The interval at which states are requested [ms]. */
const refreshEveryMs = 1500;

/** The experimenter's page: one study, its participants and the actions on them. */
function ExperimenterPage() {
  if (!client.value) {
    return (
      <section class="card">
        <SignIn />
      </section>
    );
  }
  return (
    <>
      <section class="card bar">
        <StudyChooser chosen={study.value?.plan.id} none="No studies yet" choose={openStudy} />
        <SignOutButton />
        <span class={online.value ? 'badge live' : 'badge lost'}>{online.value ? 'connected' : 'no connection'}</span>
      </section>
      <p role="status" class="soft">
        {notice}
      </p>
      <p role="alert" class="complaint">
        {problem.value}
      </p>
      {study.value ? <Study study={study.value} /> : <NewStudy />}
    </>
  );
}

render(<ExperimenterPage />, pageElement('content', HTMLElement));
resume(openStudy);
setInterval(() => {
  if (document.visibilityState === 'visible') void refresh();
}, refreshEveryMs);
