import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import type { PosePacket } from '../protocol/pose-packet';
import type { ArrivedPose } from './connection';
import { Playback, type PlaybackReport } from './playback';

/** Another player as drawn in this frame. The same object in every frame: copy what you keep. */
export interface RemotePlayer {
  readonly seat: number;
  /** The pose in the floor frame of the seat. */
  readonly pose: AvatarPose;
  readonly fingers: PosePacket['fingers'];
  /** 1: live. Less: a ghost, because no packet has arrived for a while. */
  readonly opacity: number;
}

/** Plays the packets of the other players with a jitter buffer for each. */
export interface RemotePlayers {
  receive(arrived: ArrivedPose): void;
  /**
   * Returns the players to draw at this time of the page's clock [s], without those silent for 3 s. The same list in
   * every frame.
   */
  follow(time: number): readonly RemotePlayer[];
  /**
   * Starts all playbacks over with their next packet: the page was hidden, and its clock does not show how long the
   * others were silent.
   */
  resume(): void;
  /** Discards the packets of a seat that another person has taken. */
  forget(seat: number): void;
  /** Returns the measurements of a seat's playback; null: no packet has arrived from it. */
  report(seat: number): PlaybackReport | null;
}

interface Seated {
  readonly playback: Playback;
  /** The entry in the list that `follow` returns. */
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
    resume() {
      for (const { playback } of players.values()) playback.resume();
    },
    forget(seat) {
      players.delete(seat);
    },
    report: (seat) => players.get(seat)?.playback.report() ?? null,
  };
}
