import { allReleased, type HandButtons, type TrackingFrame } from 'threepoint/core';
import {
  identity,
  invertTransform,
  type TrackedPose,
  transformPoint,
  transformPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { BallGestures, ballRules, rackPosition, stations } from 'threepoint-games/ball';
import { wristAround } from '../../../src/games/fist';
import { leftThrower, told } from './playing';

type Side = 'left' | 'right';
type Hand = {
  readonly fist: Vec3;
  readonly trigger: number;
  readonly device?: number;
  readonly kind?: HandButtons['kind'];
};

/** Returns a thrower in a running match whose hands are set frame by frame (arena frame; null: tracking lost). */
export function ballThrower(rateHz = 90) {
  const arenaFromFloor = stations[leftThrower]!;
  const floorFromArena = invertTransform(arenaFromFloor);
  let { state } = told();
  const gestures = new BallGestures(() => ({ player: leftThrower, matchAhead: -100, arenaFromFloor, state }));
  const actions: string[] = [];
  let time = 100;
  let held: Readonly<Record<Side, number | null>> = { left: null, right: null };
  const tracked = (side: Side, hand: Hand | null): TrackedPose | null =>
    hand && {
      ...transformPose(floorFromArena, wristAround<'arena'>(side, hand.fist, vec3(0, 0, -1), vec3(0, 1, 0))),
      tracking: 'tracked',
    };
  const buttonsOf = (hand: Hand | null): HandButtons => ({
    ...allReleased,
    ...(hand && { trigger: hand.trigger }),
    ...(hand?.kind && { kind: hand.kind }),
    ...(hand?.device !== undefined && { device: hand.device }),
  });
  const self = {
    /** The positions of ball 0 in its rack and of two places in front of the body, arena frame [m]. */
    ball: rackPosition(0, 20),
    chest: transformPoint(arenaFromFloor, vec3(0.2, 1.4, -0.3)),
    side: transformPoint(arenaFromFloor, vec3(-0.3, 1.2, -0.3)),
    frame(left: Hand | null, right: Hand | null, suspended = false) {
      time += 1 / rateHz;
      const head: TrackedPose = { position: vec3(0, 1.6, 0), orientation: identity, tracking: 'tracked' };
      const frame: TrackingFrame = {
        time,
        head,
        leftHand: tracked('left', left),
        rightHand: tracked('right', right),
        ...(suspended && { suspended }),
      };
      const done = gestures.follow(frame, { left: buttonsOf(left), right: buttonsOf(right) });
      for (const action of done.actions) if (action.type !== 'pose') actions.push(action.type);
      const stepped = ballRules.step(state, done.actions);
      state = stepped.state;
      gestures.onEvents(stepped.events);
      held = done.held;
      return self;
    },
    hold(left: Hand | null, right: Hand | null, seconds: number, suspended = false) {
      for (let i = 0; i < seconds * rateHz; i++) self.frame(left, right, suspended);
      return self;
    },
    /** Grabs ball 0 with the right hand and holds it in front of the chest for 0.3 s. */
    carry(device?: number) {
      const more = device === undefined ? {} : { device };
      const left = { fist: self.side, trigger: 0, ...(device === undefined ? {} : { device: device + 1 }) };
      self.frame(left, { fist: self.ball, trigger: 0, ...more });
      self.frame(left, { fist: self.ball, trigger: 1, ...more });
      return self.hold(left, { fist: self.chest, trigger: 1, ...more }, 0.3);
    },
    get held() {
      return held;
    },
    get actions() {
      return actions;
    },
    get state() {
      return state;
    },
  };
  return self;
}
