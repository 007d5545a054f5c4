import { expect, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import type { ParticipantState } from '../../../src/study/model/progress/study-api';
import { timeLeft } from '../../../src/study/pages/experimenter/time-left';
import { paperPlan } from '../model/studies';

const plan = paperPlan();
const members = scheduleFor(plan, 'P01').groups.ball?.members as [string, string, string];

/** The state of a participant in the first match, whose page reported this long ago. */
const stateOf = (participant: string, remainingSeconds: number, silence: number, running = true): ParticipantState => ({
  ...{ participant, version: 1, invitation: null, claimed: true, withdrawn: false, records: 3 },
  session: {
    ...{ step: 'ball/1/trial-1', kind: 'trial', running, paused: false, unwell: false, waiting: false, stopped: false },
    remainingSeconds,
    silence,
  },
});

const shown = (states: readonly ParticipantState[]) =>
  states.map((state) => timeLeft(states, scheduleFor(plan, state.participant), state));

test('one match has one clock in the table, that of the page that reported last', () => {
  const [first, second, third] = members;
  const states = [stateOf(first, 40, 2), stateOf(second, 12, 30), stateOf(third, 41, 0.5)];
  expect(shown(states)).toEqual([41, 41, 41]);
});

test('a participant who has not started has the whole time, and another group its own clock', () => {
  const [first, second] = members;
  const stranger = ['P01', 'P02', 'P03', 'P04', 'P05'].find((code) => !members.includes(code)) as string;
  const states = [stateOf(first, 40, 1), stateOf(second, 90, 1, false), stateOf(stranger, 20, 0)];
  expect(shown(states)).toEqual([40, 90, 20]);
});
