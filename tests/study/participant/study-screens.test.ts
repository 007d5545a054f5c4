import { describe, expect, test } from 'vitest';
import { createParticipantClient } from '../../../src/study/client/study-client';
import { Phrases } from '../../../src/study/model/phrases/phrases';
import type { ProgressEvent } from '../../../src/study/model/progress/apply-event';
import { screenOf, uploadStatusText } from '../../../src/study/participant/screens/study-screens';
import type { ScreenActions, StudySituation } from '../../../src/study/participant/screens/study-situation';
import { ParticipantSession, startSession } from '../../../src/study/participant/session/participant-session';
import { aWomanOf26, paperPlan } from '../model/studies';
import { toTheFirstRest } from './participant-device';

const plan = paperPlan();
const consent = { type: 'consent', version: plan.consent.version, motion: false } as const;
const demographics = { type: 'demographics', demographics: aWomanOf26 } as const;
const measured = { type: 'calibrated', calibration: { eyeHeight: 1.62, armSpan: 1.5 } } as const;

/**
 * A participant of the paper's study on a device without storage and without a server, after these events; the clock
 * stands.
 */
function participant(...events: readonly ProgressEvent[]) {
  let now = 1_800_000_000;
  const claim = { plan, token: 'a token', withdrawalCode: 'a code', simulated: false, progress: null };
  const session = new ParticipantSession(
    startSession(claim as Parameters<typeof startSession>[0], { study: plan.id, participant: 'P01' }),
    { records: [], motion: [] },
    { client: createParticipantClient('http://127.0.0.1:9'), vault: null, now: () => now, onChange: () => undefined },
  );
  const apply = (event: ProgressEvent) => expect(session.apply(event)).toBeNull();
  events.forEach(apply);
  return {
    session,
    apply,
    pass(seconds: number) {
      now += seconds;
    },
    /** What is seen in this situation; in the headset, all prepared, unless it says otherwise. */
    screen: (situation: Partial<StudySituation> = {}) =>
      screenOf(
        {
          ...{
            session,
            inSession: true,
            questionnaire: { question: 0, typed: null, triedToSubmit: false },
            calibration: null,
            rejection: null,
            stopping: false,
            setupProblems: [],
            withdrawalPage: 'https://lab.example.org/withdraw?study=paper',
          },
          ...{ prepared: { state: 'ready', reason: '' }, playing: false, waitingFor: null },
          ...{ standing: false, awaited: null },
          ...situation,
        },
        // Nothing is pressed on these screens.
        {} as ScreenActions,
      ),
  };
}

/** A participant who has played the practice and the first round and sits before the questions. */
function beforeTheQuestions() {
  const one = participant();
  toTheFirstRest(one.session);
  one.pass(60);
  one.apply({ type: 'tick' });
  expect(one.session.step.kind).toBe('questionnaire');
  return one;
}

describe('a participant who is to be measured', () => {
  test('reads why the measurement failed, and may try again', () => {
    const failed = participant(consent, demographics).screen({
      calibration: { kind: 'failed', fault: 'handsUnseen', text: '' },
    });
    expect(failed).toMatchObject({
      id: 'calibration-failed',
      text: ['Your hands were not seen. Hold them where you can see them.'],
    });
    expect(failed?.buttons.map(({ id }) => id)).toEqual(['calibrate']);
  });
});

describe('a participant before a round', () => {
  test('cannot start a round that is still loading, and reads how long it lasts', () => {
    const one = participant(consent, demographics, measured);
    expect(one.session.step.kind).toBe('tutorial');
    const loading = one.screen({ prepared: { state: 'loading', reason: '' } });
    expect(loading?.buttons[0]).toMatchObject({ id: 'start', look: 'off' });
    const ready = one.screen();
    expect(ready).toMatchObject({ id: 'tutorial-ready', title: 'Practice' });
    expect(ready?.buttons[0]).toMatchObject({ label: 'Start', look: 'primary' });
    const step = one.session.step as { readonly seconds: number };
    expect(ready?.text.join(' ')).toContain(`${Math.round(step.seconds)} seconds`);
  });

  test('never learns the condition, only the number of the round', () => {
    const one = beforeTheQuestions();
    const seen = JSON.stringify(one.screen());
    for (const { id, label } of plan.conditions) {
      expect(seen).not.toContain(`"${id}"`);
      expect(seen).not.toContain(label);
    }
  });
});

describe('a participant who plays', () => {
  const playing = () => participant(consent, demographics, measured, { type: 'start' });

  test('reads for which participants the game waits, and when another one pauses it', () => {
    const one = playing();
    expect(one.screen({ playing: true, waitingFor: ['P02', 'P03'] })).toMatchObject({
      id: 'waiting',
      text: ['It begins as soon as P02 and P03 are ready too.'],
    });
    expect(one.screen({ playing: true, waitingFor: ['P02'] })?.text[0]).toContain('P02 is ready');
    expect(one.screen({ playing: true, standing: true })?.id).toBe('standing');
    const awaited = { participants: ['P02'], secondsLeft: 34.2 };
    expect(one.screen({ playing: true, standing: true, awaited })).toMatchObject({
      text: [expect.stringContaining('waits for P02'), expect.stringContaining('given up')],
      figure: '0:35',
    });
    const paused = one.screen({ playing: true, standing: true, awaited: { ...awaited, secondsLeft: null } });
    expect(paused).toMatchObject({ text: [expect.stringContaining('waits for P02')], figure: null });
    expect(one.screen({ awaited })?.text[0]).toContain('Your group is waiting for you');
  });
});

describe('a participant with a questionnaire', () => {
  test('sees how much time is left, and is not hurried when it is over', () => {
    const one = beforeTheQuestions();
    expect(one.screen()?.footnote).toMatch(/^7:00 left/);
    one.pass(61);
    expect(one.screen()?.footnote).toMatch(/^5:59 left/);
    one.pass(600);
    expect(one.screen()?.footnote).toMatch(/^Take the time you need/);
  });
});

describe('the upload status', () => {
  const safe = { unsent: 0, unsaved: 0, storageFault: null, online: true, rejection: null, lockedOut: false };
  test.each([
    [{}, 'Everything is saved.', false],
    [{ unsent: 2 }, 'Sending …', false],
    [{ unsent: 1, online: false }, 'No connection: 1 record is kept on this device and sent later.', false],
    [{ unsaved: 3 }, 'Saving …', false],
    [
      { unsaved: 3, storageFault: 'the disk is full' },
      'Keep this page open: 3 records cannot be stored on this device (the disk is full).',
      true,
    ],
    [
      { unsent: 2, rejection: 'no such study' },
      'Call the experimenter: the server refuses 2 records (no such study). They stay here.',
      true,
    ],
  ])('%j is shown in a sentence, with whether data are at risk', (change, text, worrying) => {
    expect(uploadStatusText({ ...safe, ...change }, new Phrases('en'))).toEqual([text, worrying]);
  });
});
