import { describe, expect, test } from 'vitest';
import { Phrases } from '../../../src/study/model/phrases/phrases';
import { setupProblems } from '../../../src/study/model/plan/remote-setup';
import { uploadStatusText } from '../../../src/study/participant/screens/study-screens';
import { aWomanOf26 } from '../model/studies';
import { agree, canStart } from './participant-steps';
import { browser, type Tab } from './study-browser';
import { studyServer } from './study-server';

const english = new Phrases('en');
const remote = { contact: 'Write to lab@example.org', freeSpace: 2 };
const sound = { deviceProblem: null, room: { width: 2.4, depth: 2.1 }, eyeHeight: 1.6 };

async function alone(): Promise<Tab> {
  const tab = await browser(await studyServer({ remote })).open();
  await agree(tab);
  expect(tab.display.asked('demographics').done(aWomanOf26)).toBeNull();
  return tab;
}

const textOf = ({ display }: Tab) => display.screen?.text.join(' ') ?? '';

describe('the set-up of a participant who takes part alone', () => {
  test('is accepted with a headset, enough room and a standing eye height', () => {
    expect(setupProblems(remote, sound, english)).toEqual([]);
    expect(setupProblems(remote, { ...sound, room: null, eyeHeight: null }, english)).toEqual([]);
  });

  test.each([
    [{ deviceProblem: { kind: 'no-webxr' } as const }, /no WebXR\. Open this link in the browser of your headset/],
    [{ room: { width: 3, depth: 1.2 } }, /leaves 3\.0 m by 1\.2 m, the games need 2\.0 m/],
    [{ eyeHeight: 0.8 }, /0\.8 m above the floor\. Stand up/],
    [{ eyeHeight: 2.3 }, /2\.3 m above the floor: the floor of the headset is too low/],
  ])('is reported if it is unsuitable: %j', (change, words) => {
    const faults = setupProblems(remote, { ...sound, ...change }, english);
    expect(faults).toHaveLength(1);
    expect(faults[0]).toMatch(words);
  });
});

describe('a study without an experimenter present', () => {
  test('reports a device without a headset and shows the contact', async () => {
    const tab = await alone();
    expect(tab.display.shown).toBe('calibration-enter');
    tab.host.fault = { kind: 'no-headset' };
    tab.pass(1);
    expect(tab.display.shown).toBe('setup');
    expect(textOf(tab)).toContain('No headset is connected');
    expect(textOf(tab)).toContain('lab@example.org');
    expect(tab.display.screen?.buttons.map(({ id }) => id)).toEqual(['ask-to-stop']);
  });

  test('never asks to call an experimenter, and shows the contact of the plan instead', async () => {
    const server = await studyServer({ remote });
    const device = browser(server);
    const stranger = await device.open({ invitation: 'AAAA-BBBB-CCCC-DDDD' });
    await stranger.display.asked('consent').agree({ motion: false, language: null });
    const complaint = stranger.display.asked('participant').problem;
    expect(complaint).toContain(remote.contact);
    const tab = await browser(server).open();
    await agree(tab);
    const late = await browser(server).open();
    const taken = await late.display.asked('consent').agree({ motion: false, language: null });
    expect(taken).toMatch(/^P01 is taken by another device: .*\. Write to lab@example\.org$/);
    tab.wear(true);
    await tab.exchange();
    server.store.deletion.delete('paper', 'P01', 'experimenter', 1e9);
    await tab.exchange();
    const form = tab.display.asked('locked-out');
    expect(form.contact).toBe(remote.contact);
    const sheet = tab.display.inHeadset;
    expect(sheet?.text).toContain(remote.contact);
    const said = [complaint, taken, sheet?.title, ...(sheet?.text ?? [])].join(' ');
    expect(said).not.toMatch(/experimenter/i);
  });

  test('reports what the server refuses, and that the participant can go on', () => {
    const refused = { unsent: 2, unsaved: 0, storageFault: null, online: true, rejection: 'no', lockedOut: false };
    expect(uploadStatusText(refused, english, remote)).toEqual([
      'They stay on this device: the server refuses 2 records (no). You can go on. Write to lab@example.org',
      true,
    ]);
  });

  test('begins only within a boundary that is large enough', async () => {
    const tab = await alone();
    tab.host.free = { width: 1, depth: 3 };
    tab.wear(true);
    expect(tab.display.inHeadset?.id).toBe('setup');
    expect(textOf(tab)).toContain('1.0 m by 3.0 m');
    tab.host.free = { width: 2.2, depth: 3 };
    tab.pass(1);
    expect(tab.display.inHeadset?.id).toBe('calibration');
  });

  test('repeats the measurement of a seated participant and accepts that of a standing one', async () => {
    const tab = await alone();
    tab.wear(true);
    tab.host.eyes = 0.9;
    tab.display.press('calibrate');
    tab.draw(6);
    expect(tab.display.inHeadset?.id).toBe('setup');
    expect(textOf(tab)).toContain('0.9 m above the floor. Stand up');
    expect(tab.visit.state().step).toBe('archery/1/calibration');
    tab.host.eyes = 1.6;
    tab.display.press('calibrate');
    tab.draw(6);
    await canStart(tab);
    expect(tab.visit.state().step).toBe('archery/1/tutorial');
  });
});
