import { defaultAvatar, defaultCalibration, type Mutable, type RemotePerson } from 'threepoint/core';
import { type MutableTransform, makeTransform } from 'threepoint/math';
import type { ReceivedPose } from './connection';
import { Playback, type PlaybackReport } from './playback';

type PersonBuffer = Mutable<RemotePerson> & { readonly placement: MutableTransform<'floor', 'floor'> };

interface Seated {
  readonly playback: Playback;
  /** The entry in the list that `follow` returns. */
  readonly remote: PersonBuffer;
}

function seated(id: number): Seated {
  const playback = new Playback();
  const { pose } = playback.shown;
  const looks = { calibration: defaultCalibration, avatar: defaultAvatar, palette: null };
  return { playback, remote: { id, ...looks, pose, placement: makeTransform(), opacity: 1 } };
}

/** Plays the packets of the other players with a jitter buffer for each. */
export class RemotePlayers {
  readonly #players = new Map<number, Seated>();
  readonly #drawn: PersonBuffer[] = [];
  #followedAt = 0;

  receive({ seat, packet, arrivedAt }: ReceivedPose): void {
    const player = this.#players.get(seat) ?? seated(seat);
    this.#players.set(seat, player);
    player.playback.receive(packet, arrivedAt);
  }

  /**
   * Returns the players to draw at this time of the page's clock [s], without those silent for 3 s. The same list in
   * every frame. The caller sets looks and placement, which no packet contains.
   */
  follow(time: number): readonly PersonBuffer[] {
    this.#drawn.length = 0;
    this.#followedAt = time;
    this.#players.forEach(this.#draw);
    return this.#drawn;
  }

  /**
   * Starts all playbacks over with their next packet: the page was hidden, and its clock does not show how long the
   * others were silent.
   */
  resume(): void {
    for (const { playback } of this.#players.values()) playback.resume();
  }

  /** Discards the packets of a seat that another person has taken. */
  forget(seat: number): void {
    this.#players.delete(seat);
  }

  /** Returns the measurements of a seat's playback; null: no packet has arrived from it. */
  report(seat: number): PlaybackReport | null {
    return this.#players.get(seat)?.playback.report() ?? null;
  }

  readonly #draw = ({ playback, remote }: Seated): void => {
    const opacity = playback.advance(this.#followedAt);
    if (opacity === null) return;
    remote.opacity = opacity;
    this.#drawn.push(remote);
  };
}
