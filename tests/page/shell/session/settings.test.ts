import { describe, expect, test } from 'vitest';
import type { Preferences } from '../../../../src/page/shell/session/preferences';
import { createSettings, SettingsWriter } from '../../../../src/page/shell/session/settings';
import { readSwitches } from '../../../../src/page/shell/session/switches';
import { memoryStorage } from './memory-storage';

/** Settings of a visit with this address by a person whose browser remembers this. */
const visit = (query: string, remembered: Preferences = {}) =>
  createSettings(readSwitches(query).switches, { preferences: { overlay: false, ...remembered } }, null);

describe('the settings of a new visit', () => {
  test('a first visit has a mirror, sound, the bow in the left hand, and nothing calibrated', () => {
    expect(visit('')).toMatchObject({
      ...{
        mirror: true,
        sound: true,
        bowSide: 'left',
        oneHanded: false,
        upperBodyOnly: false,
        actor: true,
        mouse: false,
      },
      calibrationSource: 'not calibrated yet',
    });
  });

  test('include those that were remembered', () => {
    const calibration = { eyeHeight: 1.5, armSpan: 1.4 };
    const remembered = { mirror: false, sound: false, bowSide: 'right', name: 'Robin' } as const;
    const settings = visit('', { ...remembered, calibration });
    expect(settings).toMatchObject({ ...remembered, calibrationSource: 'remembered' });
  });

  test('the address has the last word on the name, and on who moves the body', () => {
    expect(visit('?name=Kim', { name: 'Robin' }).name).toBe('Kim');
    expect(visit('?actor=off').actor).toBe(false);
  });

  test('the controls are open, unless they were left closed, and the address has the last word', () => {
    expect(visit('').panel).toBe(true);
    expect(visit('', { panel: false }).panel).toBe(false);
    expect(visit('?panel=on', { panel: false }).panel).toBe(true);
    expect(visit('?panel=off', { panel: true }).panel).toBe(false);
  });

  test('a player without a name keeps the guest’s number through a reload, in this tab alone', () => {
    const tab = memoryStorage();
    const visited = () => createSettings(readSwitches('').switches, { preferences: {} }, tab).defaultName;
    const first = visited();
    expect(first).toMatch(/^Guest \d\d$/);
    expect(Array.from({ length: 20 }, visited)).toEqual(Array(20).fill(first));
    expect(new Set(Array.from({ length: 20 }, () => visit('').defaultName)).size).toBeGreaterThan(1);
  });

  test('a round is as long as the game has it, unless the address says', () => {
    expect(visit('')).not.toHaveProperty('seconds');
    expect(visit('?seconds=40').seconds).toBe(40);
  });
});

describe('bots', () => {
  test('play along in a room of one’s own, as they did last time', () => {
    expect(visit('').bots).toBe(true);
    expect(visit('', { bots: false }).bots).toBe(false);
  });

  test('stay away from a room open to others unless the address asks, even if remembered', () => {
    expect(visit('?room=garden', { bots: true }).bots).toBe(false);
    expect(visit('?room=garden&bots=on').bots).toBe(true);
    expect(visit('?bots=off', { bots: true }).bots).toBe(false);
  });
});

describe('the writer of the settings', () => {
  function written() {
    const settings = visit('');
    const kept: unknown[] = [];
    const mirrors: boolean[] = [];
    const store = { remember: (part: object) => void kept.push(part) };
    return {
      settings,
      kept,
      mirrors,
      writer: new SettingsWriter(settings, store, () => mirrors.push(settings.mirror)),
    };
  }

  test('tells of every change once it is made, and remembers what lasts longer than a visit', () => {
    const { settings, kept, mirrors, writer } = written();
    writer.keep({ mirror: false });
    expect(settings.mirror).toBe(false);
    expect(mirrors).toEqual([false]);
    expect(kept).toEqual([{ mirror: false }]);
  });

  test('forgets with the visit what is for the visit', () => {
    const { settings, kept, mirrors, writer } = written();
    writer.change({ debugSkeleton: true });
    expect(settings.debugSkeleton).toBe(true);
    expect(mirrors).toEqual([true]);
    expect(kept).toEqual([]);
  });
});
