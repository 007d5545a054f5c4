import { firstLine, reasonOf } from 'threepoint/core';
import {
  createEnterButton,
  createNotices,
  type EnterButton,
  installTrustedTypesPolicy,
  type Notices,
  pageElement,
} from 'threepoint-ui';
import { createPage, type Page } from './shell/create-page';
import { createFrameLoop } from './shell/frame-loop';
import type { Headset } from './shell/session/headset';
import { readPageContext } from './shell/session/page-context';
import { PageLoading } from './shell/session/page-loading';
import { joinStudy } from './shell/stage/join-study';

/** Shows uncaught errors as notices. */
function reportFaults(notices: Notices): void {
  const wentWrong = (text: string) => notices.show('error', `Something went wrong: ${firstLine(text)}`, 'fault');
  window.addEventListener('error', ({ message }) => wentWrong(message));
  window.addEventListener('unhandledrejection', ({ reason }) => wentWrong(reasonOf(reason)));
}

/** Replaces a page that cannot start by its error. */
function showStartFailure(error: unknown): void {
  const text = document.createElement('p');
  text.className = 'fault';
  text.setAttribute('role', 'alert');
  text.textContent = `threepoint cannot start: ${firstLine(reasonOf(error))}`;
  document.body.replaceChildren(text);
}

/** How long the note stays that no headset was found [ms]: long enough to read it twice. */
const noteMs = 10_000;

/** Prepares the headset, and enables the button for a real or an emulated session. */
async function offerSessions(headset: Headset, button: EnterButton, study: boolean): Promise<void> {
  const { real, sentence, passthrough } = await headset.prepare();
  const offer = {
    label: real ? 'Enter VR' : 'Enter VR (emulated)',
    passthroughLabel: passthrough && !study ? 'Enter AR' : null,
    enabled: true,
  };
  button.show({ ...offer, sentence: sentence && `${sentence} An emulated headset takes its place.` });
  setTimeout(() => button.show({ ...offer, sentence: null }), noteMs);
}

/** Starts the frame loop. The panel is open as the address asks, else as in the last visit. */
function run({ controls, stage, frame, body, timing, settings }: Page): void {
  controls.setPanelOpen(settings.panel);
  controls.layOut();
  const loop = createFrameLoop<XRFrame>(frame, body, timing);
  stage.renderer.setAnimationLoop((timestampMs, deviceFrame) => loop(timestampMs, deviceFrame ?? undefined));
}

/** Shows the first body: the built-in avatar, moved by IK. Nothing is drawn before, because nothing would be seen. */
async function showFirstBody(page: Page): Promise<void> {
  const { avatarShown, frame, loading } = page;
  await avatarShown;
  loading.mark('avatar');
  loading.report('the avatar', 1);
  run(page);
  await frame.nextPicture();
  loading.bodyShown();
}

/**
 * Goes to the place in the address, and then opens what the address asks for: arriving in a game ends a replay and
 * closes the controls.
 */
async function openFromAddress({ activities, controls, mocap, recorder, stage, switches }: Page): Promise<void> {
  // These requests precede anything that the user opens meanwhile.
  const [replay, motion] = [recorder.nextRequest(), recorder.nextRequest()];
  await activities.goTo(switches.play);
  if (switches.view) stage.view.setView(switches.view);
  if (switches.panel) controls.setPanelOpen(true);
  if (switches.replay) void controls.openRecording(switches.replay, replay);
  if (switches.mocap) void mocap.open(switches.mocap.addresses, switches.mocap, motion);
}

/** Takes part in the study that the address asks for, if it does. */
async function joinStudyOfAddress(page: Page): Promise<void> {
  const { study } = page.switches;
  if (study) await joinStudy(page, study);
}

/** Stores an offline copy of the page after everything has loaded. A study needs its server, so it stores none. */
function storeOfflineCopy({ kept, switches }: Page): void {
  // Only a production build has a service worker.
  if (import.meta.env.PROD && !switches.study) void kept.keep(navigator.serviceWorker);
}

/** Builds the page and opens it; resolves when everything has loaded. */
async function start(): Promise<void> {
  installTrustedTypesPolicy();
  const notices = createNotices(pageElement('notices', HTMLElement));
  reportFaults(notices);
  const loading = new PageLoading();
  loading.mark('script');
  const page = createPage(readPageContext(notices), loading);
  const { switches, settings, store, writer, avatar, body, controls, headset, timing } = page;

  // The built-in avatar is shown until another one has been loaded, and stays if that fails.
  if (switches.avatar) {
    const address = switches.avatar;
    void avatar.open(address).then((outcome) => (outcome === 'motion' ? page.mocap.open([address]) : undefined));
  } else if (!switches.study) void controls.openStoredAvatar();
  const enter = (passthrough: boolean) => {
    if (passthrough !== settings.passthrough) writer.keep({ passthrough });
    void headset.enter(passthrough);
  };
  const enterButton = createEnterButton(pageElement('enter', HTMLElement), enter);
  await showFirstBody(page);
  // IK draws until the network is ready. It has 3 MB and its own thread, which the first body need not share.
  const sessionsOffered = offerSessions(headset, enterButton, switches.study !== null);
  const chosen = body.setEstimator(switches.estimator ?? store.preferences.estimator ?? 'learned');
  void chosen.then(() => loading.report('the network', 1));
  await Promise.all([chosen, sessionsOffered, openFromAddress(page)]);
  await joinStudyOfAddress(page);
  loading.finish();
  void page.stage.studio.openWindows();
  // Compiling shaders is loading, not drawing.
  timing.reset();
  controls.show();
  storeOfflineCopy(page);
}

start().catch(showStartFailure);
