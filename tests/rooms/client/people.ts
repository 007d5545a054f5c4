import { defaultCalibration, unknownFingers } from 'threepoint/core';
import { add, identity, invertTransform, type Pose, type Side, transformPose, type Vec3, vec3 } from 'threepoint/math';
import { wristAround } from 'threepoint-games';
import { type BallConnection, type BallEvent, type BallGame, rackPosition, stations } from 'threepoint-games/ball';
import type { ConnectionUpdate, OutgoingPose, Visitor } from '../../../src/rooms/client/connection';
import { inFront as opening, velocityTo } from '../../games/ball/playing';

export const visitor = (name: string, more: Partial<Visitor> = {}): Visitor => ({
  name,
  calibration: defaultCalibration,
  ...more,
});

/** The target of the throwers: the opening of the basket in front of the holder, arena frame. */
export { opening, velocityTo };

const eyes = vec3(0, 1.6, 0);

/** A player who stands where their seat is, with their wrists at these places of the arena. */
export function shownAt(
  connection: Pick<BallConnection, 'arenaFromFloor'>,
  seat: number,
  wrists: Readonly<Record<Side, Pose<'arena'> | null>>,
): OutgoingPose {
  const floorFromArena = invertTransform(connection.arenaFromFloor(seat));
  const hand = (side: Side) => {
    const wrist = wrists[side];
    return wrist && { ...transformPose(floorFromArena, wrist), tracking: 'tracked' as const };
  };
  return {
    jump: false,
    pose: {
      head: { position: eyes, orientation: identity, tracking: 'tracked' },
      leftHand: hand('left'),
      rightHand: hand('right'),
      body: null,
    },
    fingers: unknownFingers,
  };
}

/** Wrists round these fists, knuckles ahead, thumbs up. */
export const fists = (left: Vec3, right: Vec3 = left): Record<Side, Pose<'arena'>> => ({
  left: wristAround('left', left, vec3(0, 0, -1), vec3(0, 1, 0)),
  right: wristAround('right', right, vec3(0, 0, -1), vec3(0, 1, 0)),
});

/** Wrists that hold the basket's rim on both sides, opening upward. */
export const holding = (middle: Vec3): Record<Side, Pose<'arena'>> => ({
  left: wristAround('left', add(middle, vec3(0.22, 0, 0)), vec3(0, 0, 1), vec3(0, 1, 0)),
  right: wristAround('right', add(middle, vec3(-0.22, 0, 0)), vec3(0, 0, 1), vec3(0, 1, 0)),
});

/** Returns the place at which a thrower of this seat releases the ball. */
export const releaseOf = (seat: number): Vec3 => add(stations[seat]!.position, vec3(0, 1.6, -0.5));

type Update = ConnectionUpdate<BallGame>;
type Action = BallGame['action'];
type Unnumbered = Action extends infer D ? (D extends Action ? Omit<D, 'sequence'> : never) : never;

/** A person at a connection: does what a page would do every frame, and records what it received. */
export function createPerson(connection: BallConnection) {
  const events: BallEvent[] = [];
  const news: Update['changes'][number][] = [];
  const poses: Update['poses'][number][] = [];
  let sequence = 0;
  let wrists: Record<Side, Pose<'arena'> | null> = { left: null, right: null };
  const act = (action: Unnumbered): Action => {
    sequence += 1;
    const numbered = { ...action, sequence } as Action;
    connection.sendAction(numbered);
    return numbered;
  };
  return {
    connection,
    events,
    news,
    poses,
    get seat() {
      return connection.room?.mySeat ?? -1;
    },
    get match() {
      return connection.room!.match!;
    },
    place(next: typeof wrists) {
      wrists = next;
    },
    act,
    grab: (ball: number, side: Side = 'right') => act({ type: 'grab', side, ball }),
    /** Into the basket, from where the fists are. */
    toss(ball: number, time: number, to: Vec3 = opening, side: Side = 'right') {
      const from = releaseOf(connection.room!.mySeat!);
      return act({
        type: 'throw',
        side,
        ball,
        at: time + connection.room!.matchClockOffset,
        position: from,
        velocity: velocityTo(from, to, 1),
      });
    },
    /** One frame of a page. */
    frame(time: number) {
      const update = connection.update(time);
      events.push(...update.events);
      news.push(...update.changes);
      poses.push(...update.poses);
      const seat = connection.room?.mySeat ?? null;
      if (seat !== null) connection.sendPose(time, shownAt(connection, seat, wrists));
      return update;
    },
    happened: <T extends BallEvent['type']>(type: T) =>
      events.filter((event): event is Extract<BallEvent, { type: T }> => event.type === type),
  };
}
export type Person = ReturnType<typeof createPerson>;

/** A fist at a ball's place in its rack. */
export const atRack = (ball: number, balls = 20) => fists(rackPosition(ball, balls));
