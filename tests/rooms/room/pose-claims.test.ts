import { vec3 } from 'threepoint/core/math/vec3';
import { describe, expect, test } from 'vitest';
import { fists } from '../client/people';
import { packetAt, toldRoom } from './told-room';

describe('of poses the Room does not believe', () => {
  test('a head that is suddenly elsewhere, unless its space was re-anchored; after a second it is believed', () => {
    const told = toldRoom();
    told.join('ann');
    const at = (x: number) => packetAt(told.room.match, 0, fists(vec3(x, 1, 0)), told.time);
    expect(told.room.onPose('ann', at(0), told.time)).toBe('taken');
    told.tick();
    expect(told.room.onPose('ann', at(0), told.time)).toBe('taken');
    told.tick();
    // Bits 16 on after the header are the head's x: the same packet, 8 m aside.
    const moved = at(0);
    moved[4] = (moved[4]! + 0x20) & 0xff;
    expect(told.room.onPose('ann', moved, told.time)).toBe('ignored');
    expect(told.refusals).toMatchObject([{ what: 'pose', reason: 'too-fast' }]);
    told.pass(1.1);
    const later = at(0);
    later[4] = (later[4]! + 0x20) & 0xff;
    expect(told.room.onPose('ann', later, told.time)).toBe('taken');
  });

  test('poses that arrive twice, late or not at all like poses', () => {
    const told = toldRoom();
    told.join('ann');
    const first = packetAt(told.room.match, 0, fists(vec3(0, 1, 0)), told.time);
    told.tick();
    const second = packetAt(told.room.match, 0, fists(vec3(0, 1, 0)), told.time);
    expect(told.room.onPose('ann', second, told.time)).toBe('taken');
    expect(told.room.onPose('ann', second, told.time)).toBe('ignored');
    expect(told.room.onPose('ann', first, told.time)).toBe('ignored');
    expect(told.room.onPose('ann', new Uint8Array(40), told.time)).toBe('bad');
  });
});
