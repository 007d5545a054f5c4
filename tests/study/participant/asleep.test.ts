import { describe, expect, test } from 'vitest';
import { reportFigures } from '../../reliability/report-figures';
import { beforeTheRound, canStart, play } from './participant-steps';
import type { Tab } from './study-browser';
import { type StudyServer, studyServer } from './study-server';

const hour = 3600;

const recordsOf = <Kind extends string>({ store }: StudyServer, kind: Kind) =>
  store.records.all('paper').filter((record) => record.kind === kind);

function answer(tab: Tab, questions: number): void {
  for (let i = 1; i <= questions; i++) {
    const field = tab.display.screen?.question?.field;
    if (field?.kind !== 'likert') throw new Error(`expected a Likert scale on "${tab.display.shown}"`);
    field.choose(4);
    if (i < questions) tab.display.press('next');
  }
}

const clocks = [
  { name: 'the time of day alone', both: false },
  { name: 'both clocks', both: true },
];

describe.each(clocks)('a machine sleeps for an hour, of which $name has it', ({ name, both }) => {
  test('in a round, which goes on with the seconds that were played', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    tab.display.press('start');
    tab.draw(1);
    tab.sleep(hour, both);
    tab.draw(1);
    expect(tab.visit.state()).toMatchObject({ running: true, step: 'archery/1/trial-1' });
    tab.host.games.archery.hit(40);
    tab.draw(3);
    await tab.exchange();
    expect(tab.display.shown).toBe('rest');
    const [, round] = recordsOf(server, 'trial');
    expect(round?.body).toMatchObject({ outcome: { seconds: 5, ended: 'arrows', score: 40 } });
    expect(recordsOf(server, 'event')).toEqual([]);
  });

  test('in a rest, which is over, and in questions, which lie open and say how long', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    play(tab, 40);
    expect(tab.display.shown).toBe('rest');
    tab.sleep(hour, both);
    tab.draw(1);
    expect(tab.display.shown).toBe('question-Q1');
    tab.sleep(hour, both);
    tab.draw(1);
    answer(tab, 7);
    tab.display.press('submit');
    await tab.exchange();
    const [answers] = recordsOf(server, 'answers');
    expect(answers?.body).toMatchObject({ overtime: true });
    expect(tab.visit.state()).toMatchObject({ unsent: 0, unsaved: 0, online: true });
    reportFigures('asleep', { [`study, ${name}: records refused`]: tab.visit.state().unsent });
  });

  test('with the headset off, and the commands of the experimenter arrive', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    tab.display.press('start');
    tab.draw(1);
    tab.wear(false);
    tab.sleep(hour, both);
    tab.wear(true);
    await canStart(tab);
    await server.experimenter.command('paper', 'P01', { type: 'pause' });
    await tab.exchange();
    expect(tab.display.shown).toBe('paused');
    expect(recordsOf(server, 'event').map(({ body }) => (body as { type: string }).type)).toEqual([
      'interrupted',
      'pause',
    ]);
  });
});
