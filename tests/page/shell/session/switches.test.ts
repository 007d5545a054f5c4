import { describe, expect, test } from 'vitest';
import { readSwitches } from '../../../../src/page/shell/session/switches';

describe('the address of the page', () => {
  test('asks for nothing by itself', () => {
    expect(readSwitches('')).toEqual({
      complaints: [],
      switches: {
        emulate: false,
        cameras: false,
        actor: true,
        panel: null,
        estimator: null,
        ep: null,
        avatar: null,
        quality: null,
        replay: null,
        mocap: null,
        view: null,
        play: 'studio',
        seed: null,
        seconds: null,
        room: null,
        name: null,
        bots: null,
        balls: null,
        spectate: false,
        study: null,
      },
    });
  });

  test('chooses estimator, provider, avatar, quality and the emulator', () => {
    const { switches, complaints } = readSwitches(
      '?emulate&actor=off&estimator=ik&ep=webgpu&avatar=/a.vrm&quality=low',
    );
    expect(complaints).toEqual([]);
    expect(switches).toMatchObject({
      emulate: true,
      actor: false,
      estimator: 'ik',
      ep: 'webgpu',
      avatar: '/a.vrm',
      quality: 'low',
    });
  });

  test('opens motion capture with its skeleton at a second, with another method beside it', () => {
    const { switches, complaints } = readSwitches(
      '?mocap=a/01_02.amc+a/01.asf&at=12.5&beside=paper&truth=inside&clip=2',
    );
    expect(complaints).toEqual([]);
    const outlook = { at: 12.5, beside: 'paper', truth: 'inside', clip: 1 };
    expect(switches.mocap).toEqual({ addresses: ['a/01_02.amc', 'a/01.asf'], ...outlook });
    expect(readSwitches('?at=3').switches.mocap).toBe(null);
    expect(readSwitches('?mocap=a.bvh&at=soon').complaints).toHaveLength(1);
  });

  test('names a study and who takes part; a participant alone is none', () => {
    expect(readSwitches('?study=paper&participant=P07').switches.study).toEqual({ study: 'paper', participant: 'P07' });
    expect(readSwitches('?study=paper').switches.study).toEqual({ study: 'paper', participant: null });
    expect(readSwitches('?participant=P07').switches.study).toBe(null);
    expect(readSwitches('?study=Paper%2F..&participant=P07').complaints).toHaveLength(1);
  });

  test('a value that no switch takes is reported and counts as not given; the others count', () => {
    const { switches, complaints } = readSwitches('?estimator=magic&quality=low&ep=gpu');
    expect(switches).toMatchObject({ estimator: null, quality: 'low', ep: null });
    expect(complaints).toHaveLength(2);
    expect(complaints.join(' ')).toContain('estimator=magic');
    expect(complaints.join(' ')).toContain('ep=gpu');
  });

  test('the values that a switch takes are described in words, not in patterns', () => {
    const asked =
      '?replay=&avatar=&seconds=x&balls=99&seed=-1&room=Our%20Room&study=..&participant=me&actor=maybe&view=top';
    const { switches, complaints } = readSwitches(asked);
    expect(complaints).toContain('The address has replay= without a value: replay takes the address of a recording.');
    expect(complaints).toContain(
      'The address has seconds=x, which is not a valid value: seconds takes a whole number from 1 to 3600.',
    );
    expect(complaints).toContain(
      'The address has balls=99, which is not a valid value: balls takes a whole number from 1 to 20.',
    );
    expect(complaints).toHaveLength(10);
    for (const complaint of complaints) expect(complaint).not.toMatch(/[/^\\>(){}|"]/);
    expect(switches).toMatchObject({ replay: null, seconds: null, balls: null, seed: null, room: null, study: null });
  });

  test('a round may be as long as a room takes it, and no longer', () => {
    expect(readSwitches('?seconds=3600').switches.seconds).toBe(3600);
    expect(readSwitches('?seconds=3601')).toMatchObject({
      switches: { seconds: null },
      complaints: [expect.anything()],
    });
  });

  test('a value without end is shown as far as it is read', () => {
    const [complaint] = readSwitches(`?ep=${'x'.repeat(5000)}`).complaints;
    expect(complaint?.length).toBeLessThan(160);
  });
});
