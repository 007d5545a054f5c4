import { describe, expect, test } from 'vitest';
import { decodeFrame } from '../../../src/rooms/protocol/pose-frame';
import { fists, opening, releaseOf } from '../client/people';
import { createTestRoom } from './test-room';

describe('poses and stillness of a room', () => {
  test('poses go out once, all that have come in one frame, each as it was sent', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.frames.length = 0;
    const older = testRoom.packet(0, fists(releaseOf(0)));
    expect(testRoom.send('ann', older)).toBe('taken');
    const newest = testRoom.packet(0, fists(opening), testRoom.time + 0.005);
    expect(testRoom.room.onPose('ann', newest, testRoom.time + 0.005)).toBe('taken');
    const cals = testRoom.packet(2, fists(opening), testRoom.time + 0.005);
    testRoom.room.onPose('cal', cals, testRoom.time + 0.005);
    testRoom.tick();
    testRoom.tick();
    expect(testRoom.frames).toHaveLength(1);
    const poses = decodeFrame(testRoom.frames[0]!);
    expect(poses?.map(({ seat, bytes }) => [seat, [...bytes]])).toEqual([
      [0, [...older]],
      [0, [...newest]],
      [2, [...cals]],
    ]);
  });

  test('after a standstill of its host a room passes on a seat’s newest poses alone', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.frames.length = 0;
    const packets = Array.from({ length: 30 }, (_, i) =>
      testRoom.packet(0, fists(releaseOf(0)), testRoom.time + 0.01 * (i + 1)),
    );
    for (const [i, packet] of packets.entries()) testRoom.room.onPose('ann', packet, testRoom.time + 0.01 * (i + 1));
    testRoom.tick();
    const sent = decodeFrame(testRoom.frames[0]!)?.map(({ bytes }) => [...bytes]);
    expect(sent).toEqual(packets.slice(-16).map((packet) => [...packet]));
  });

  test('a room in which nothing moves is still, and any sign of life wakes it', () => {
    const testRoom = createTestRoom();
    expect(testRoom.room.isIdle).toBe(true);
    testRoom.join('ann');
    expect(testRoom.room.isIdle).toBe(false);
    testRoom.pass(31);
    expect(testRoom.room.isIdle).toBe(true);
    testRoom.pose('ann', 0, fists(releaseOf(0)));
    expect(testRoom.room.isIdle).toBe(false);
    testRoom.pass(31);
    expect(testRoom.room.isIdle).toBe(true);
    testRoom.room.disconnect('ann', testRoom.time);
    expect(testRoom.room.isIdle).toBe(false);
    testRoom.pass(31);
    expect(testRoom.room.isIdle).toBe(true);
    expect(testRoom.room.census.empty).toBe(true);
  });

  test('a room whose match runs is not still, however silent its players', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.pass(20);
    expect(testRoom.room.isIdle).toBe(false);
    testRoom.pass(100);
    expect(testRoom.room.match.phase).toBe('over');
    expect(testRoom.room.isIdle).toBe(true);
  });
});
