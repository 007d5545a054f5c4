import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import type { PosePacket } from '../protocol/pose-packet';
import type { ArrivedPose } from './connection';
import { Playback, type PlaybackReport } from './playback';

/** Another player as they are to be drawn now: the same object in every frame, so copy what must stay. */
export interface RemotePlayer {
  readonly seat: number;
  /** Floor frame of their seat. */
  readonly pose: AvatarPose;
  readonly fingers: PosePacket['fingers'];
  /** 1: live. Less: a ghost, because nothing was heard of them for a while. */
  readonly opacity: number;
}

/** The newest packets of the other players, played back a moment late so that frames come evenly. */
export interface RemotePlayers {
  receive(arrived: ArrivedPose): void;
  /** The players to be drawn at this time of the page's clock [s]; silent for 3 s: not drawn. The same list in every frame. */
  follow(time: number): readonly RemotePlayer[];
  /** Another person sits there now. */
  forget(seat: number): void;
  /** null: no one has been heard from this seat. */
  report(seat: number): PlaybackReport | null;
}

interface Seated {
  readonly playback: Playback;
  /** What is drawn of them, as `follow` lists it. */
  readonly remote: RemotePlayer & { opacity: number };
}

function seated(seat: number): Seated {
  const playback = new Playback();
  const { pose, fingers } = playback.shown;
  return { playback, remote: { seat, pose, fingers, opacity: 1 } };
}

export function createRemotePlayers(): RemotePlayers {
  const players = new Map<number, Seated>();
  const drawn: RemotePlayer[] = [];
  let followedAt = 0;

  function draw({ playback, remote }: Seated): void {
    const opacity = playback.follow(followedAt);
    if (opacity === null) return;
    remote.opacity = opacity;
    drawn.push(remote);
  }

  return {
    receive({ seat, packet, arrivedAt }) {
      const player = players.get(seat) ?? seated(seat);
      players.set(seat, player);
      player.playback.receive(packet, arrivedAt);
    },
    follow(time) {
      drawn.length = 0;
      followedAt = time;
      players.forEach(draw);
      return drawn;
    },
    forget(seat) {
      players.delete(seat);
    },
    report: (seat) => players.get(seat)?.playback.report() ?? null,
  };
}
