import type { Mutable, RemotePerson, TrackingFrame } from 'threepoint/core';
import {
  type MutableVec3,
  makePose,
  type Side,
  type TrackedPose,
  type Transform,
  transformPoint,
  transformTracked,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { ballInPalm } from 'threepoint-games';
import {
  type BallConnection,
  type BallRoomView,
  type BallState,
  ballRadius,
  basketInHands,
  isInZone,
  type Opening,
} from 'threepoint-games/ball';
import type { PlayerFrame } from '../../ball/match/ball-frame';
import { seatLooks } from '../view/seat-looks';
import { proximityFade } from './proximity-fade';

/** The frame of one seat, with the buffers that it overwrites. */
interface SeatView {
  readonly player: Mutable<Omit<PlayerFrame, 'palms'>> & { readonly palms: Record<Side, Vec3 | null> };
  /** null: the person has not been seen yet. */
  body: Mutable<RemotePerson> | null;
  readonly head: MutableVec3;
  readonly palms: Readonly<Record<Side, MutableVec3>>;
}

/** Head and hands of a player, in that player's floor frame. */
interface Place {
  readonly head: { readonly position: Vec3 };
  readonly leftHand: TrackedPose | null;
  readonly rightHand: TrackedPose | null;
}

/** The people of a room in one frame, for those parts that draw them. The next frame overwrites all objects. */
export class CourtPeople {
  readonly players: (PlayerFrame | null)[] = [];
  readonly bodies: RemotePerson[] = [];
  /**
   * The opening of the basket at the last tracked pose of its holder's hands, arena frame; null: not tracked since the
   * room last moved the basket.
   */
  opening: Opening | null = null;
  /** The basket in the newest state of the room. */
  private basket: BallState['basket'] | null = null;
  private readonly views: SeatView[] = [];
  private readonly left = makePose<'arena'>();
  private readonly right = makePose<'arena'>();
  private readonly head = vec3(0, 0, 0);

  /** Updates all people. `frame`: the user's hands, null if nothing is tracked. */
  update(
    connection: BallConnection,
    seen: BallRoomView,
    frame: TrackingFrame | null,
    others: readonly RemotePerson[],
  ): void {
    const { seats, mySeat } = seen;
    const shown = seen.match;
    this.players.length = seats.length;
    this.bodies.length = 0;
    if (shown?.basket !== this.basket) this.opening = null;
    this.basket = shown?.basket ?? null;
    if (!shown) return;
    for (let seat = 0; seat < seats.length; seat++) {
      const row = seats[seat];
      const player = shown.players[seat];
      const there = seat === mySeat ? null : remoteOn(seat, others);
      const arenaFromFloor = connection.arenaFromFloor(seat);
      const place = seat === mySeat ? frame : (there?.pose ?? null);
      if (player?.role === 'holder' && place) {
        this.opening = this.openingOf(place, arenaFromFloor, player.station) ?? this.opening;
      }
      this.players[seat] = null;
      if (!row) continue;
      const view = this.viewOf(seat);
      if (there) {
        view.body ??= { ...there };
        const body: Mutable<RemotePerson> = Object.assign(view.body, there);
        body.palette = seatLooks[player?.station ?? seat]?.palette ?? 'porcelain';
        body.opacity = there.opacity * (frame ? proximityFade(frame.head.position, there.pose, body.placement) : 1);
        this.bodies.push(body);
      }
      if (!player) continue;
      const entry = view.player;
      entry.name = row.name;
      entry.bot = row.bot;
      entry.presence = row.presence;
      entry.me = seat === mySeat;
      entry.role = player.role;
      entry.station = player.station;
      entry.ready = player.ready;
      entry.head = place && transformPoint(arenaFromFloor, place.head.position, view.head);
      entry.palms.left = palmIn(arenaFromFloor, place?.leftHand, view.palms.left);
      entry.palms.right = palmIn(arenaFromFloor, place?.rightHand, view.palms.right);
      entry.opacity = entry.me ? 1 : (there?.opacity ?? 0);
      this.players[seat] = entry;
    }
  }

  /** Returns the opening by the rules; null: no tracked hand or a holder outside the zone, so the basket stays. */
  private openingOf(
    { head, leftHand, rightHand }: Place,
    arenaFromFloor: Transform<'arena', 'floor'>,
    station: number,
  ): Opening | null {
    if (!isInZone(transformPoint(arenaFromFloor, head.position, this.head), station)) return null;
    return basketInHands(
      transformTracked(arenaFromFloor, leftHand, this.left),
      transformTracked(arenaFromFloor, rightHand, this.right),
    );
  }

  private viewOf(seat: number): SeatView {
    const known = this.views[seat];
    if (known) return known;
    const view = makeSeatView(seat);
    this.views[seat] = view;
    return view;
  }
}

const makeSeatView = (seat: number): SeatView => ({
  player: {
    name: '',
    bot: false,
    presence: 'here',
    me: false,
    role: 'thrower',
    station: seat,
    ready: false,
    head: null,
    palms: { left: null, right: null },
    opacity: 0,
  },
  body: null,
  head: vec3(0, 0, 0),
  palms: { left: vec3(0, 0, 0), right: vec3(0, 0, 0) },
});

function remoteOn(seat: number, others: readonly RemotePerson[]): RemotePerson | null {
  for (const other of others) if (other.id === seat) return other;
  return null;
}

/** Returns the position of a ball in a hand, arena frame, or null if the hand is not tracked. */
function palmIn(
  arenaFromFloor: Transform<'arena', 'floor'>,
  hand: TrackedPose | null | undefined,
  target: MutableVec3,
): MutableVec3 | null {
  return hand ? transformPoint(arenaFromFloor, ballInPalm(hand, ballRadius, target), target) : null;
}
