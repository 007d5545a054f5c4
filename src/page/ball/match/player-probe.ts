import { defaultAvatar } from 'threepoint/core/body/built-in-bodies';
import type { Vec3 } from 'threepoint/core/math/vec3';
import type { RoomBodies } from 'threepoint-rooms/drawing/room-bodies';
import type { PlayerProbe } from '../../activity/activity';
import type { BallPlay } from './ball-play';

const triple = ({ x, y, z }: Vec3): readonly [number, number, number] => [x, y, z];

/** The other players as they are drawn now. */
export function playerProbes(
  { newest, room }: Pick<BallPlay, 'newest' | 'room'>,
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
