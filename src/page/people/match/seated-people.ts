import type { Mutable, RemotePerson, TrackingFrame } from 'threepoint/core';
import { type MutableVec3, type TrackedPose, transformPoint, type Vec3, vec3 } from 'threepoint/math';
import type { Connection, HostedGame, RoomView } from 'threepoint-rooms/room';
import { seatLooks } from '../view/seat-looks';
import type { SeatFrame } from './match-frame';
import { proximityFade } from './proximity-fade';
import type { SeatedGame } from './seated-game';

/** Head and hands of a player, in that player's floor frame. */
export interface PlayerPose {
  readonly head: { readonly position: Vec3 };
  readonly leftHand: TrackedPose | null;
  readonly rightHand: TrackedPose | null;
}

/** The frame of one seat, with the buffers that it overwrites. */
interface SeatView {
  readonly player: Mutable<SeatFrame>;
  /** null: the person has not been seen yet. */
  body: Mutable<RemotePerson> | null;
  readonly head: MutableVec3;
}

/** The people of a room in one frame, for those parts that draw them. The next frame overwrites all objects. */
export class SeatedPeople<Game extends HostedGame> {
  readonly players: (SeatFrame | null)[] = [];
  readonly bodies: RemotePerson[] = [];
  /** Head and hands by seat; null: not visible now. */
  readonly poses: (PlayerPose | null)[] = [];
  readonly #game: Pick<SeatedGame<Game>, 'stationOf'>;
  readonly #ownName: string | null;
  readonly #views: SeatView[] = [];

  /** `ownName`: the displayed name of the user; null: the one that others see. */
  constructor(game: Pick<SeatedGame<Game>, 'stationOf'>, ownName: string | null) {
    this.#game = game;
    this.#ownName = ownName;
  }

  /** Updates all people. `frame`: the user's hands, null if nothing is tracked. */
  update(
    connection: Connection<Game>,
    { seats, mySeat, match }: RoomView<Game>,
    frame: TrackingFrame | null,
    others: readonly RemotePerson[],
  ): void {
    this.players.length = seats.length;
    this.poses.length = seats.length;
    this.bodies.length = 0;
    if (!match) return;
    for (let seat = 0; seat < seats.length; seat++) {
      const row = seats[seat];
      const player = match.players[seat];
      const there = seat === mySeat ? null : remoteOn(seat, others);
      const pose = seat === mySeat ? frame : (there?.pose ?? null);
      this.poses[seat] = pose;
      this.players[seat] = null;
      if (!row) continue;
      const view = this.#viewOf(seat);
      const station = this.#game.stationOf(match, seat);
      if (there) {
        view.body ??= { ...there };
        const body: Mutable<RemotePerson> = Object.assign(view.body, there);
        body.palette = seatLooks[station]?.palette ?? 'porcelain';
        body.opacity = there.opacity * (frame ? proximityFade(frame.head.position, there.pose, body.placement) : 1);
        this.bodies.push(body);
      }
      if (!player) continue;
      const entry = view.player;
      entry.bot = row.bot;
      entry.presence = row.presence;
      entry.me = seat === mySeat;
      entry.name = (entry.me && this.#ownName) || row.name;
      entry.station = station;
      entry.ready = player.ready;
      entry.head = pose && transformPoint(connection.arenaFromFloor(seat), pose.head.position, view.head);
      entry.opacity = entry.me ? 1 : (there?.opacity ?? 0);
      this.players[seat] = entry;
    }
  }

  #viewOf(seat: number): SeatView {
    const known = this.#views[seat];
    if (known) return known;
    const view = makeSeatView(seat);
    this.#views[seat] = view;
    return view;
  }
}

const makeSeatView = (seat: number): SeatView => ({
  player: {
    name: '',
    bot: false,
    presence: 'here',
    me: false,
    station: seat,
    ready: false,
    head: null,
    opacity: 0,
  },
  body: null,
  head: vec3(0, 0, 0),
});

function remoteOn(seat: number, others: readonly RemotePerson[]): RemotePerson | null {
  for (const other of others) if (other.id === seat) return other;
  return null;
}
