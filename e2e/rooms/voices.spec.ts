import { expect } from '@playwright/test';
import { serviceOf } from '../browser-processes';
import { cutNetwork } from '../cut-network';
import { emulatedHeadset, type Point } from '../emulated-headset';
import { lookingAtMenu, pressBelow, pressInMenu, recordCanvasText } from '../page/hands-on-menu';
import { distance, enterVr, joinedRoom, keepPicture, probe } from '../page-fixture';
import {
  attenuation,
  bar,
  connected,
  expectSilence,
  expectVoices,
  joinVoices,
  otherOf,
  test,
  voicesOf,
} from '../talkers';

test('people hear each other 6 dB softer at twice the distance, nobody muted, hidden or gone @realtime', async ({
  serve,
  talker,
}) => {
  test.setTimeout(600_000);
  const { origin } = await serve();
  const { page: ann } = await talker(origin, 'Ann', { query: 'emulate&actor=off' });
  const { page: ben } = await talker(origin, 'Ben');
  await joinVoices(ann);
  await joinVoices(ben);
  await connected(ann);
  await connected(ben);
  expect(await voicesOf(ann)).toMatchObject({ muted: true, people: [{ voice: 'muted' }] });
  await expectSilence(ann);

  await bar(ben).getByRole('button', { name: 'Unmute me' }).click();
  await expectVoices(ann);
  await expect(bar(ann)).toContainText('can be heard');
  await expectSilence(ben);

  await ben.getByRole('button', { name: 'Play as basket holder' }).click();
  await expect.poll(async () => (await otherOf(ann))?.seat).toBe(2);
  await connected(ann);
  await expectVoices(ann);
  await keepPicture(ann, 'voices-desk');

  await ann.keyboard.press('t');
  await expectVoices(ben);
  await expect(bar(ann).getByRole('button', { name: 'Mute me' })).toBeVisible();
  await ann.keyboard.press('t');
  await expectSilence(ben);

  const headset = await emulatedHeadset(ann);
  await headset.place({ head: { position: [0, 1.6, 0] } });
  await enterVr(ann, { stepMs: null });
  const shown = await ann.waitForFunction(() => window.threepoint?.probe().players[0]?.joints.head);
  const there = (await shown.jsonValue()) as Point;
  const far = distance([0, there[1], 0], there);
  const levels: number[] = [];
  const metres = [1, 2, 4, 8];
  const yaw = Math.atan2(-there[0], -there[2]);
  const orientation = [0, Math.sin(yaw / 2), 0, Math.cos(yaw / 2)] as const;
  const stand = async (away: number): Promise<void> => {
    const at: Point = [there[0] * (1 - away / far), there[1], there[2] * (1 - away / far)];
    await headset.place({ head: { position: at, orientation } });
    await expect.poll(async () => distance((await probe(ann)).tracking?.head ?? [9, 9, 9], at)).toBeLessThan(0.02);
  };
  for (const away of metres) {
    await stand(away);
    levels.push(await attenuation(ann));
  }
  console.log(`voices: ${metres.map((away, i) => `${away} m ${levels[i]?.toFixed(1)} dB`).join(', ')}`);
  for (const [i, level] of levels.slice(1).entries()) {
    expect(levels[i]! - level, `from ${metres[i]} m to ${metres[i + 1]} m`).toBeGreaterThan(4);
    expect(levels[i]! - level, `from ${metres[i]} m to ${metres[i + 1]} m`).toBeLessThan(7);
  }
  await stand(2);
  await expect.poll(async () => (await otherOf(ann))?.level).toBeGreaterThan(0.5);
  await keepPicture(ann, 'voices-vr');
  await bar(ben).getByRole('button', { name: 'Mute me' }).click();
  await expect.poll(async () => (await otherOf(ann))?.voice).toBe('muted');
  await keepPicture(ann, 'voices-vr-muted');
  await stand(0.35);
  await expect.poll(async () => (await probe(ann)).players[0]?.opacity).toBeLessThan(0.7);
  await bar(ben).getByRole('button', { name: 'Unmute me' }).click();
  await headset.endSession();

  await bar(ann)
    .getByRole('button', { name: /^Mute . · Ben/ })
    .click();
  await expectSilence(ann);
  await expect(bar(ann)).toContainText('muted by you');
  await bar(ann)
    .getByRole('button', { name: /Unmute . · Ben/ })
    .click();
  await expectVoices(ann);
  await bar(ann)
    .getByRole('button', { name: /Hide . · Ben/ })
    .click();
  await expectSilence(ann);
  await expect.poll(async () => (await probe(ann)).players[0]?.drawnAs).toBeNull();
  await bar(ann)
    .getByRole('button', { name: /Show . · Ben/ })
    .click();
  await expectVoices(ann);
  await expect.poll(async () => (await probe(ann)).players[0]?.drawnAs).toBe('woman');

  await bar(ben).getByRole('button', { name: 'Leave voice chat' }).click();
  await expectSilence(ann);
  await expect.poll(async () => (await otherOf(ann))?.voice).toBe('none');
});

test('one of two people is muted, then hidden, by the headset’s menu; the desk’s list agrees @nightly', async ({
  serve,
  talker,
}) => {
  test.setTimeout(600_000);
  const { origin } = await serve();
  const { page: ann } = await talker(origin, 'Ann', {
    query: 'emulate&actor=off',
    inPage: recordCanvasText,
    viewport: { width: 800, height: 500 },
  });
  // The name has the maximum length.
  const long = 'Wilhelmina Montgomer';
  const { page: ben } = await talker(origin, 'Ben', { seldomDrawn: true });
  const { page: mina } = await talker(origin, long, { seldomDrawn: true });
  for (const page of [ann, ben, mina]) await joinVoices(page);
  for (const page of [ben, mina]) await bar(page).getByRole('button', { name: 'Unmute me' }).click();
  const person = async (seat: number) => (await voicesOf(ann)).people.find((each) => each.seat === seat);
  const drawnAs = async (seat: number) => (await probe(ann)).players.find((each) => each.seat === seat)?.drawnAs;
  await expect.poll(async () => (await person(1))?.link).toBe('connected');
  await expect.poll(async () => (await person(2))?.link).toBe('connected');
  await expectVoices(ann);

  const headset = await emulatedHeadset(ann);
  await headset.place({ head: lookingAtMenu });
  await enterVr(ann, { stepMs: null });
  await pressInMenu(ann, 'Players');
  await pressBelow(ann, 'Ben', 'Mute');
  await expect.poll(() => person(1)).toMatchObject({ silenced: true, hidden: false, level: 0 });
  // The one who is left.
  await expectVoices(ann);
  await keepPicture(ann, 'voices-players-vr');
  await pressBelow(ann, long, 'Mute');
  await expectSilence(ann);
  await pressBelow(ann, 'Ben', 'Unmute');
  await expectVoices(ann);

  await pressBelow(ann, 'Ben', 'Hide');
  await expectSilence(ann);
  await expect.poll(() => drawnAs(1)).toBeNull();
  expect(await drawnAs(2)).toBe('woman');
  await keepPicture(ann, 'voices-players-hidden-vr');
  await headset.place({ head: { position: [0, 1.6, 0.6], orientation: [0, 0, 0, 1] } });
  await keepPicture(ann, 'voices-marked-vr');
  await headset.endSession();
  await expect(bar(ann).getByRole('button', { name: /Show . · Ben/ })).toBeVisible();
  await expect(bar(ann).getByRole('button', { name: /^Mute . · Ben/ })).toBeDisabled();
  await keepPicture(ann, 'voices-marked-desk');
  // Two lines of a narrow bar at most: beside the buttons it would be cut into pieces of three letters.
  const name = await bar(ann).getByText(long, { exact: true }).boundingBox();
  expect(name?.height).toBeLessThan(50);
  await bar(ann)
    .getByRole('button', { name: new RegExp(`Unmute . · ${long}`) })
    .click();
  await expectVoices(ann);
  await bar(ann)
    .getByRole('button', { name: /Show . · Ben/ })
    .click();
  await expect.poll(() => drawnAs(1)).toBe('woman');
});

test('a voice comes back after the network was lost, and with the page after a reload @realtime', async ({
  serve,
  talker,
}) => {
  test.setTimeout(300_000);
  const { origin } = await serve();
  const { page: ann } = await talker(origin, 'Ann');
  const { page: ben, pid } = await talker(origin, 'Ben');
  await joinVoices(ann);
  await joinVoices(ben);
  await connected(ann);
  await bar(ben).getByRole('button', { name: 'Unmute me' }).click();
  await expectVoices(ann);

  const mend = cutNetwork(pid);
  try {
    await expectSilence(ann);
    await expect.poll(async () => (await otherOf(ann))?.link, { timeout: 60_000 }).toBe('lost');
  } finally {
    mend();
  }
  const mended = performance.now();
  await expectVoices(ann);
  console.log(`voices: heard again ${((performance.now() - mended) / 1000).toFixed(1)} s after the network came back`);
  await connected(ann);

  await ben.reload();
  await joinedRoom(ben);
  await expectSilence(ann);
  await joinVoices(ben);
  await connected(ann);
  await bar(ben).getByRole('button', { name: 'Unmute me' }).click();
  await expectVoices(ann);
});

/** In the page: a test can ask the microphones that it was given. */
function keepMicrophones(): void {
  const kept: MediaStreamTrack[] = [];
  window.microphonesOfPage = kept;
  const { mediaDevices } = navigator;
  const given = mediaDevices.getUserMedia.bind(mediaDevices);
  mediaDevices.getUserMedia = async (constraints) => {
    const stream = await given(constraints);
    kept.push(...stream.getAudioTracks());
    return stream;
  };
}

test('a microphone that its device ends is taken again; the others see a refusal @realtime', async ({
  serve,
  talker,
}) => {
  test.setTimeout(300_000);
  const { origin } = await serve();
  const { page: ann } = await talker(origin, 'Ann', { seldomDrawn: true });
  const { page: ben, pid } = await talker(origin, 'Ben', { seldomDrawn: true, inPage: keepMicrophones });
  const microphones = () => ben.evaluate(() => window.microphonesOfPage?.map(({ readyState }) => readyState));
  for (const page of [ann, ben]) {
    await joinVoices(page);
    await bar(page).getByRole('button', { name: 'Unmute me' }).click();
  }
  await expectVoices(ann);
  await expectVoices(ben);

  // All audio of this browser restarts, as after a headset's sleep: tracks end by themselves, contexts are suspended.
  process.kill(serviceOf(pid, 'AudioService'), 'SIGKILL');
  await expect.poll(microphones).toEqual(['ended', 'live']);
  await expectVoices(ann);
  await expectVoices(ben);
  await expect(bar(ben).getByRole('button', { name: 'Mute me (T)', exact: true })).toBeVisible();

  // Taking the permission back ends the microphone too.
  await ben.context().clearPermissions();
  await expect(bar(ben)).toContainText('The browser blocks the microphone');
  await expect(bar(ben)).toContainText('You can still hear the others.');
  await expectSilence(ann);
  await expect.poll(async () => (await otherOf(ann))?.voice).toBe('muted');
  await expectVoices(ben);

  await ben.context().grantPermissions(['microphone'], { origin });
  await bar(ben).getByRole('button', { name: 'Find a microphone' }).click();
  await expectVoices(ann);
  expect(await microphones()).toEqual(['ended', 'ended', 'live']);
});

test('a sentence says what keeps a person from talking: refused, no microphone, no seat, no voices @nightly', async ({
  serve,
  talker,
}) => {
  test.setTimeout(600_000);
  const { origin } = await serve();
  const { page: refused } = await talker(origin, 'Ann', { microphone: 'refused', seldomDrawn: true });
  await joinVoices(refused);
  await expect(bar(refused)).toContainText('The browser blocks the microphone');
  await expect(bar(refused)).toContainText('You can still hear the others.');

  const { page: without } = await talker(origin, 'Ben', { microphone: 'none' });
  await joinVoices(without);
  await expect(bar(without)).toContainText('No microphone was found. You can still hear the others.');
  await expect(bar(without).getByRole('button', { name: 'Find a microphone' })).toBeVisible();
  await keepPicture(without, 'voices-no-microphone');

  const { page: third } = await talker(origin, 'Cal', { seldomDrawn: true });
  await joinVoices(third);
  await bar(third).getByRole('button', { name: 'Unmute me' }).click();
  await expectVoices(refused);
  await expectVoices(without);

  const { page: fourth } = await talker(origin, 'Dot');
  await bar(fourth).getByRole('button', { name: 'Talk with the others' }).click();
  await expect(bar(fourth)).toContainText('You are watching. Only players on the seats can talk.');
  await keepPicture(fourth, 'voices-names');
  expect((await voicesOf(fourth)).people.every(({ link }) => link === 'none')).toBe(true);

  const { origin: silentOrigin } = await serve({ THREEPOINT_VOICES: 'off' });
  const { page: off } = await talker(silentOrigin, 'Eve', { seldomDrawn: true });
  await expect.poll(async () => (await voicesOf(off)).phase).toBe('none');
  await expect(off.getByRole('button', { name: 'Talk with the others' })).toHaveCount(0);
  const allowed = () => document.featurePolicy?.allowsFeature('microphone') ?? null;
  expect([await fourth.evaluate(allowed), await off.evaluate(allowed)]).toEqual([true, false]);
});

declare global {
  interface Window {
    /** Put there by `keepMicrophones`: all tracks of microphones that the page was given. */
    microphonesOfPage?: MediaStreamTrack[];
  }
  interface Document {
    /** Chromium's own. */
    readonly featurePolicy?: { allowsFeature(feature: string): boolean };
  }
}
