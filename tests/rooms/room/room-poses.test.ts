import { decodeFrame } from 'threepoint-rooms/protocol/pose-frame';
import { describe, expect, test } from 'vitest';
import { fists, opening, releaseOf } from '../client/people';
import { packetAt, toldRoom } from './told-room';

describe('poses and stillness of a room', () => {
  test('poses go out once, all that have come in one frame, each as it was sent', () => {
    const told = toldRoom();
    told.begin();
    told.frames.length = 0;
    const older = packetAt(told.room.match, 0, fists(releaseOf(0)), told.time);
    expect(told.room.onPose('ann', older, told.time)).toBe('taken');
    const newest = packetAt(told.room.match, 0, fists(opening), told.time + 0.005);
    expect(told.room.onPose('ann', newest, told.time + 0.005)).toBe('taken');
    const cals = packetAt(told.room.match, 2, fists(opening), told.time + 0.005);
    told.room.onPose('cal', cals, told.time + 0.005);
    told.tick();
    told.tick();
    expect(told.frames).toHaveLength(1);
    const poses = decodeFrame(told.frames[0]!);
    expect(poses?.map(({ seat, bytes }) => [seat, [...bytes]])).toEqual([
      [0, [...older]],
      [0, [...newest]],
      [2, [...cals]],
    ]);
  });

  test('after a standstill of its host a room passes on the newest poses of a seat, and the rest is gone', () => {
    const told = toldRoom();
    told.begin();
    told.frames.length = 0;
    const packets = Array.from({ length: 30 }, (_, i) =>
      packetAt(told.room.match, 0, fists(releaseOf(0)), told.time + 0.01 * (i + 1)),
    );
    for (const [i, packet] of packets.entries()) told.room.onPose('ann', packet, told.time + 0.01 * (i + 1));
    told.tick();
    const sent = decodeFrame(told.frames[0]!)?.map(({ bytes }) => [...bytes]);
    expect(sent).toEqual(packets.slice(-16).map((packet) => [...packet]));
  });

  test('a room in which nothing moves is still, and any sign of life wakes it', () => {
    const told = toldRoom();
    expect(told.room.isStill).toBe(true);
    told.join('ann');
    expect(told.room.isStill).toBe(false);
    told.pass(4);
    expect(told.room.isStill).toBe(true);
    told.pose('ann', 0, fists(releaseOf(0)));
    expect(told.room.isStill).toBe(false);
    told.pass(4);
    expect(told.room.isStill).toBe(true);
    told.room.disconnect('ann', told.time);
    expect(told.room.isStill).toBe(false);
    told.pass(31);
    expect(told.room.isStill).toBe(true);
    expect(told.room.census.empty).toBe(true);
  });

  test('a room whose match runs is not still, however silent its players', () => {
    const told = toldRoom();
    told.begin();
    told.pass(20);
    expect(told.room.isStill).toBe(false);
    told.pass(100);
    expect(told.room.match.phase).toBe('over');
    expect(told.room.isStill).toBe(true);
  });
});
