import { vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { fists } from '../client/people';
import { createTestRoom } from './test-room';

describe('poses that the Room rejects', () => {
  test('a head suddenly elsewhere, unless its space was re-anchored; after a second it is accepted', () => {
    const testRoom = createTestRoom();
    testRoom.join('ann');
    const at = (x: number) => testRoom.packet(0, fists(vec3(x, 1, 0)));
    expect(testRoom.send('ann', at(0))).toBe('taken');
    testRoom.tick();
    expect(testRoom.send('ann', at(0))).toBe('taken');
    testRoom.tick();
    // Bits 16 on after the header are the head's x: the same packet, 8 m aside.
    const moved = at(0);
    moved[4] = (moved[4]! + 0x20) & 0xff;
    expect(testRoom.send('ann', moved)).toBe('ignored');
    expect(testRoom.refusals).toMatchObject([{ what: 'pose', reason: 'too-fast' }]);
    testRoom.pass(1.1);
    const later = at(0);
    later[4] = (later[4]! + 0x20) & 0xff;
    expect(testRoom.send('ann', later)).toBe('taken');
  });

  test('poses that arrive twice, late or not at all like poses', () => {
    const testRoom = createTestRoom();
    testRoom.join('ann');
    const first = testRoom.packet(0, fists(vec3(0, 1, 0)));
    testRoom.tick();
    const second = testRoom.packet(0, fists(vec3(0, 1, 0)));
    expect(testRoom.send('ann', second)).toBe('taken');
    expect(testRoom.send('ann', second)).toBe('ignored');
    expect(testRoom.send('ann', first)).toBe('ignored');
    expect(testRoom.send('ann', new Uint8Array(40))).toBe('bad');
  });
});
