import 'threepoint-ui/styles/study.css';
import { monotonic, type Pointer, type TrackingFrame } from 'threepoint/core';
import { rotate, vec3 } from 'threepoint/math';
import { pageFolder } from 'threepoint-ui';
import { createParticipantClient } from '../client/study-client';
import { invitationIn, studyLink, withdrawalLink } from '../client/study-link';
import { createStudyCard, type StudyCard } from './forms/study-card';
import { VrStudyPanel } from './sheet/vr-study-panel';
import type { After, StudyAddressBar, StudyDisplay } from './study-page';
import { type RequestedStudy, StudyVisit, type VisitState } from './study-visit';
import type { StudyHost } from './trial/study-host';

/** The study on the page, for its frame loop. */
export interface StudyRun {
  /** The object to add to the scene. */
  readonly object: VrStudyPanel['object'];
  /** Whether no trial is being played, so that hands that point at the sheet draw no bow. */
  readonly idle: boolean;
  readonly paused: boolean;
  /** Takes a drawn frame into account; null: the head was not seen. */
  frame(time: number, frame: TrackingFrame | null): void;
  point(pointers: readonly Pointer[]): void;
  sessionChanged(): void;
  probe(): StudyProbe;
}

/** The state of a study on the page, for tools. */
export interface StudyProbe extends VisitState {
  /** The target that a hand points at; null: none. */
  readonly pointedAt: string | null;
  readonly targets: readonly { readonly id: string; readonly at: readonly [number, number, number] }[];
}

/** Seconds since 1970, monotonic even if the system's clock is set back. */
const nowSeconds = monotonic(() => Date.now() / 1000);

const after: After = (delayMs, act) => {
  const timer = window.setTimeout(act, delayMs);
  return () => window.clearTimeout(timer);
};

/** Returns the display of the card on the desktop and the sheet in the headset, of which at most one can be pressed. */
function createDisplay(card: StudyCard, sheet: VrStudyPanel): StudyDisplay {
  let shown = 'opening';
  return {
    get shown() {
      return shown;
    },
    show(screen, inHeadset) {
      shown = screen?.id ?? 'playing';
      card.show(inHeadset ? null : screen);
      sheet.show(inHeadset ? screen : null);
    },
    ask(form, inHeadset = null) {
      shown = form.kind;
      card.ask(form);
      sheet.show(inHeadset);
    },
  };
}

const addressBarOf = (study: string): StudyAddressBar => ({
  invitation: () => invitationIn(location.hash),
  goTo(place) {
    const address = new URL(location.href);
    address.searchParams.set('participant', place.participant);
    address.hash = new URL(studyLink({ study, ...place }), location.href).hash;
    if (address.href === location.href) location.reload();
    else location.assign(address);
  },
  reload: () => location.reload(),
  withdrawalPage: () => new URL(withdrawalLink(study), `${pageFolder()}/`).href,
  reloadWhenChanged() {
    window.addEventListener('hashchange', () => location.reload());
  },
});

/** Opens the study in the address, which has the page to itself while it runs. */
export function createStudyRun(requested: RequestedStudy, host: StudyHost): StudyRun {
  document.body.classList.add('in-study');
  const sheet = new VrStudyPanel();
  const visit = new StudyVisit(requested, createParticipantClient(pageFolder()), host, {
    display: createDisplay(createStudyCard(), sheet),
    address: addressBarOf(requested.study),
    languages: navigator.languages,
    now: nowSeconds,
    after,
  });
  window.addEventListener('online', () => void visit.flow?.exchange());
  window.addEventListener('beforeunload', (event) => {
    if (visit.losesAnswers) event.preventDefault();
  });
  void visit.enter();
  return {
    object: sheet.object,
    get idle() {
      return !visit.flow?.playing;
    },
    get paused() {
      return visit.flow?.paused ?? false;
    },
    frame(time, frame) {
      if (frame) {
        const forward = rotate(frame.head.orientation, vec3(0, 0, -1));
        sheet.follow({ position: frame.head.position, forward });
      }
      visit.flow?.frame(time, frame);
    },
    point: (pointers) => sheet.point(pointers),
    sessionChanged: () => visit.flow?.sessionChanged(),
    probe: () => ({ ...visit.state(), pointedAt: sheet.pointedAt, targets: sheet.targets() }),
  };
}
