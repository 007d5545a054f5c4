import { neededBones } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { BoneChoices } from '../../../src/page/bones/bone-choices';
import { createPreferenceStore } from '../../../src/page/shell/session/preferences';
import { BoneMapStore } from '../../../src/page/shell/stage/bone-map-store';
import { memoryStorage } from '../shell/session/memory-storage';

const bones = Object.fromEntries(neededBones.map((bone) => [bone, `${bone} of the file`]));
const hashOf = (i: number) => String(i).padStart(43, 'h');

describe('a map of bones that the user makes', () => {
  const joint = (name: string) => ({ name, parent: -1, position: { x: 0, y: 0, z: 0 } });
  const choices = () =>
    new BoneChoices({
      joints: ['spih', 'enips', '', 'daeh', 'daeh'].map(joint),
      bones: { hips: 'spih', head: 'daeh' },
      confidence: { hips: 0.95, head: 0.4 },
    });

  test('gives a part one bone, and a bone one part', () => {
    const map = choices();
    map.assign(1, 'hips');
    expect(map.bones).toEqual({ hips: 'enips', head: 'daeh' });
    map.assign(1, 'spine');
    expect(map.bones).toEqual({ spine: 'enips', head: 'daeh' });
    map.assign(3, null);
    expect(map.bones).toEqual({ spine: 'enips' });
    expect(map.missing).toEqual(expect.arrayContaining(['hips', 'head', 'leftHand']));
    expect(map.missing).not.toContain('spine');
  });

  test('shows a match without confidence as unsure until the user has chosen the bone', () => {
    const map = choices();
    expect([map.isUnsure(0), map.isUnsure(1), map.isUnsure(3)]).toEqual([false, false, true]);
    map.assign(1, 'head');
    expect(map.isUnsure(1)).toBe(false);
  });

  test('names no bone without a name of its own', () => {
    expect([0, 1, 2, 3, 4].filter((each) => choices().canChoose(each))).toEqual([0, 1, 3]);
  });

  test('is remembered by the file’s hash over a reload, of the newest twenty files', () => {
    const storage = memoryStorage();
    const first = new BoneMapStore(createPreferenceStore(storage));
    for (let i = 0; i < 21; i++) first.store(hashOf(i), { ...bones, head: `daeh${i}` });
    const store = createPreferenceStore(storage);
    expect(store.complaint).toBeNull();
    const later = new BoneMapStore(store);
    expect(later.of(hashOf(0))).toBeUndefined();
    expect(later.of(hashOf(20))?.head).toBe('daeh20');
    expect(later.of('unknown')).toBeUndefined();
  });

  test('costs nothing else that is remembered where a bone has too long a name to be', () => {
    const storage = memoryStorage();
    const store = createPreferenceStore(storage);
    store.remember({ mirror: false });
    new BoneMapStore(store).store(hashOf(1), { ...bones, head: 'head '.repeat(50) });
    const next = createPreferenceStore(storage);
    expect(next.complaint).toBeNull();
    expect(next.preferences).toEqual({ mirror: false });
  });
});
