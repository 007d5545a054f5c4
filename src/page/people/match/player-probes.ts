import { defaultAvatar } from 'threepoint/core';
import type { Vec3 } from 'threepoint/math';
import type { HostedGame } from 'threepoint-rooms/room';
import type { RoomBodies } from 'threepoint-rooms/three';
import type { PlayerProbe } from '../../activity/activity';
import type { MatchPlay } from './match-play';

const triple = ({ x, y, z }: Vec3): readonly [number, number, number] => [x, y, z];

/** Returns the other players as they are drawn now. */
export function playerProbes(
  { newest, room }: Pick<MatchPlay<HostedGame>, 'newest' | 'room'>,
  others: Pick<RoomBodies, 'jointsOf' | 'drawnAs'>,
): readonly PlayerProbe[] {
  return (newest?.bodies ?? []).flatMap(({ id, opacity }): PlayerProbe[] => {
    const player = newest?.players[id];
    if (!player) return [];
    const { name, bot, presence } = player;
    const drawn = Object.entries(others.jointsOf(id) ?? {});
    const joints = Object.fromEntries(drawn.map(([joint, at]) => [joint, triple(at)] as const));
    const { avatar = defaultAvatar } = room?.seats[id] ?? {};
    return [{ seat: id, name, bot, presence, opacity, avatar, drawnAs: others.drawnAs(id), joints }];
  });
}
