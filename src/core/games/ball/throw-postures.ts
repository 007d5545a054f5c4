import { clamp } from '../../math/damper';
import { otherSide, type Side } from '../../math/side';
import { add, addScaled, distance, length, normalise, scale, subtract, type Vec3, vec3 } from '../../math/vec3';
import type { Grasp, PlayerPosture, PlayerPostures } from './player-postures';

/** The arm is this fast at once [m], then evenly fast for as long as a throw's speed is measured and a slow frame more [s]. */
const runUp = 0.24;
const evenSeconds = 0.095;
const lateSeconds = 0.02;
const slowDown = 0.24;

/** An underarm throw of a given velocity; floor frame. */
export interface SwungThrow {
  /** The arm swung back, ready to go. */
  readonly wound: PlayerPosture;
  /** At its end. */
  readonly thrown: PlayerPosture;
  readonly seconds: number;
  /** The hand opens after this many seconds of it. */
  readonly releaseAt: number;
  /** Where the fist is after so many seconds. */
  swing(seconds: number): Vec3;
}

/** What throws are made of, for somebody who faces −Z of their floor; floor frame throughout. */
export interface ThrowPostures {
  /** Arms down, eyes at a point. */
  resting(at: Vec3): PlayerPosture;
  /** The fist round a ball of the rack, the body leaning towards it as far as the arm is too short. */
  reaching(side: Side, ball: Vec3): PlayerPosture;
  /** The ball before the chest, eyes at a point. */
  carrying(side: Side, at: Vec3): PlayerPosture;
  /** Where a thrown ball leaves the hand. */
  release(side: Side): Vec3;
  /** A throw with this velocity [m/s], eyes at a point. */
  throwing(side: Side, velocity: Vec3, at: Vec3): SwungThrow;
}

/** The same posture with another grasp of one hand. */
export const withHand = (posture: PlayerPosture, side: Side, grasp: Grasp): PlayerPosture => ({
  ...posture,
  [side]: grasp,
});

export function createThrowPostures(postures: PlayerPostures): ThrowPostures {
  const { arm, eyes } = postures;

  const resting = (at: Vec3): PlayerPosture => ({
    eyes,
    gaze: postures.looking(eyes, at),
    left: postures.hanging('left', eyes),
    right: postures.hanging('right', eyes),
  });

  const outwardOf = (side: Side): number => (side === 'left' ? -1 : 1);
  const release = (side: Side): Vec3 => add(postures.shoulder(side, eyes), vec3(0, 0.06 * arm, -0.72 * arm));

  return {
    resting,
    reaching(side, ball) {
      const longest = 0.97 * arm + 0.05;
      const shoulder = postures.shoulder(side, eyes);
      const missing = Math.max(0, distance(shoulder, ball) - longest);
      const towards = normalise(subtract(ball, shoulder));
      const leaned = addScaled(eyes, towards, missing);
      const shoulderThere = postures.shoulder(side, leaned);
      return withHand(
        { ...resting(ball), eyes: leaned, gaze: postures.looking(leaned, ball), ...hangingFrom(leaned) },
        side,
        {
          fist: ball,
          knuckles: normalise(add(normalise(subtract(ball, shoulderThere)), vec3(0, -0.15, -0.4))),
          thumb: vec3(-outwardOf(side), 0.25, 0),
        },
      );
    },
    carrying(side, at) {
      const outward = outwardOf(side);
      return withHand(resting(at), side, {
        fist: add(postures.shoulder(side, eyes), vec3(-0.05 * outward * arm, -0.42 * arm, -0.62 * arm)),
        knuckles: normalise(vec3(-0.1 * outward, 0.15, -1)),
        thumb: normalise(vec3(0.7 * outward, 0.7, 0)),
      });
    },
    release,
    throwing(side, velocity, at) {
      const outward = outwardOf(side);
      const speed = length(velocity);
      const way = normalise(velocity);
      const runSeconds = (2 * runUp) / speed;
      const even = evenSeconds + lateSeconds;
      const slowSeconds = (2 * slowDown) / speed;
      const seconds = runSeconds + even + slowSeconds;
      const back = addScaled(release(side), way, -(runUp + speed * evenSeconds));
      /** From rest to the throw's speed, on at that speed until the ball has left the hand, then to rest. */
      const swing = (elapsed: number): Vec3 => {
        const running = clamp(elapsed, 0, runSeconds);
        const evenly = clamp(elapsed - runSeconds, 0, even);
        const slowing = clamp(elapsed - runSeconds - even, 0, slowSeconds);
        const along =
          runUp * (running / runSeconds) ** 2 +
          speed * evenly +
          speed * (slowing - (slowing * slowing) / (2 * slowSeconds));
        return addScaled(back, way, along);
      };
      const shoulder = postures.shoulder(side, eyes);
      const leanBack = add(eyes, vec3(0.03 * outward, -0.01, 0.06));
      const leanAhead = add(eyes, vec3(-0.02 * outward, -0.03, -0.13));
      const palmAhead = normalise(vec3(outward, 0.35, 0));
      const wound = withHand(
        withHand({ ...resting(at), eyes: leanBack, gaze: postures.looking(leanBack, at) }, side, {
          fist: back,
          knuckles: normalise(add(normalise(subtract(back, shoulder)), scale(way, 0.6))),
          thumb: palmAhead,
        }),
        otherSide(side),
        {
          fist: add(postures.shoulder(otherSide(side), leanBack), vec3(-0.1 * outward, -0.55 * arm, -0.55 * arm)),
          knuckles: normalise(vec3(0, 0.1, -1)),
          thumb: normalise(vec3(0.5 * outward, 0.8, 0)),
        },
      );
      const thrown = withHand({ ...resting(at), eyes: leanAhead, gaze: postures.looking(leanAhead, at) }, side, {
        fist: swing(seconds),
        knuckles: way,
        thumb: palmAhead,
      });
      return { wound, thrown, seconds, releaseAt: runSeconds + evenSeconds, swing };
    },
  };

  function hangingFrom(from: Vec3): Pick<PlayerPosture, Side> {
    return { left: postures.hanging('left', from), right: postures.hanging('right', from) };
  }
}
