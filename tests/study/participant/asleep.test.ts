import { describe, expect, test } from 'vitest';
import { reportFigures } from '../../reliability/report-figures';
import { beforeTheRound, canStart, handIn, play } from './participant-steps';
import { studyServer } from './study-server';

const hour = 3600;

const clocks = [
  { name: 'the time of day alone', both: false },
  { name: 'both clocks', both: true },
];

describe.each(clocks)('an hour’s sleep of a machine, of which $name has it', ({ name, both }) => {
  test('lets a round go on with the seconds that were played', async () => {
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
    const [, round] = server.bodies('trial');
    expect(round?.outcome).toMatchObject({ seconds: 5, ended: 'arrows', score: 40 });
    expect(server.events()).toEqual([]);
  });

  test('ends a rest, and leaves questions open, whose answers then say how long', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    play(tab, 40);
    expect(tab.display.shown).toBe('rest');
    tab.sleep(hour, both);
    tab.draw(1);
    expect(tab.display.shown).toBe('question-Q1');
    tab.sleep(hour, both);
    tab.draw(1);
    handIn(tab, 4);
    await tab.exchange();
    expect(server.bodies('answers')).toMatchObject([{ overtime: true }]);
    expect(tab.visit.state()).toMatchObject({ unsent: 0, unsaved: 0, online: true });
    reportFigures('asleep', { [`study, ${name}: records refused`]: tab.visit.state().unsent });
  });

  test('with the headset off holds up no commands of the experimenter', async () => {
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
    expect(server.events()).toEqual(['interrupted', 'pause']);
  });
});
