import {
  type MutableVec3,
  makePose,
  type Side,
  type TrackedPose,
  type Transform,
  transformPoint,
  transformTracked,
  vec3,
} from 'threepoint/math';
import { ballInPalm } from 'threepoint-games';
import {
  type BallConnection,
  type BallState,
  ballRadius,
  basketInHands,
  isInZone,
  type Opening,
} from 'threepoint-games/ball';
import type { PlayerPose } from '../../people/match/seated-people';
import type { Palms } from './ball-frame';

interface PalmsView {
  readonly palms: { -readonly [Each in keyof Palms]: Palms[Each] };
  readonly at: Readonly<Record<Side, MutableVec3>>;
}

/** The hands at the court in one frame: balls in palms, and the basket. The next frame overwrites all objects. */
export class CourtHands {
  readonly palms: Palms[] = [];
  /**
   * The opening of the basket at the last tracked pose of its holder's hands, arena frame; null: not tracked since the
   * room last moved the basket.
   */
  opening: Opening | null = null;
  /** The basket in the newest state of the room. */
  #basket: BallState['basket'] | null = null;
  readonly #views: PalmsView[] = [];
  readonly #left = makePose<'arena'>();
  readonly #right = makePose<'arena'>();
  readonly #head = vec3(0, 0, 0);

  /** Updates all hands. `poses`: head and hands by seat. */
  update(connection: BallConnection, { basket, players }: BallState, poses: readonly (PlayerPose | null)[]): void {
    if (basket !== this.#basket) this.opening = null;
    this.#basket = basket;
    for (let seat = 0; seat < players.length; seat++) {
      const { role, station } = players[seat]!;
      const pose = poses[seat] ?? null;
      const arenaFromFloor = connection.arenaFromFloor(seat);
      if (role === 'holder' && pose) this.opening = this.#openingOf(pose, arenaFromFloor, station) ?? this.opening;
      const view = this.#views[seat] ?? makePalmsView();
      this.#views[seat] = view;
      const { palms, at } = view;
      palms.left = palmIn(arenaFromFloor, pose?.leftHand, at.left);
      palms.right = palmIn(arenaFromFloor, pose?.rightHand, at.right);
      this.palms[seat] = palms;
    }
  }

  /** Returns the opening by the rules; null: no tracked hand or a holder outside the zone, so the basket stays. */
  #openingOf(
    { head, leftHand, rightHand }: PlayerPose,
    arenaFromFloor: Transform<'arena', 'floor'>,
    station: number,
  ): Opening | null {
    if (!isInZone(transformPoint(arenaFromFloor, head.position, this.#head), station)) return null;
    return basketInHands(
      transformTracked(arenaFromFloor, leftHand, this.#left),
      transformTracked(arenaFromFloor, rightHand, this.#right),
    );
  }
}

const makePalmsView = (): PalmsView => ({
  palms: { left: null, right: null },
  at: { left: vec3(0, 0, 0), right: vec3(0, 0, 0) },
});

/** Returns the position of a ball in a hand, arena frame, or null if the hand is not tracked. */
function palmIn(
  arenaFromFloor: Transform<'arena', 'floor'>,
  hand: TrackedPose | null | undefined,
  target: MutableVec3,
): MutableVec3 | null {
  return hand ? transformPoint(arenaFromFloor, ballInPalm(hand, ballRadius, target), target) : null;
}
