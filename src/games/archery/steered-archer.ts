import { clamp, dampVec3, subtract, type Vec3 } from 'threepoint/math';
import { minimumJerk, yawOf } from '../simulated-body';
import type { SimulatedInput } from '../simulated-input';
import { type ArcherBody, ArcherPostures, mixPostures, type Posture } from './archer-postures';

/** What a pointer asks of an archer. */
export interface Steering {
  /** The point of the arena to hit. */
  readonly target: Vec3;
  /** true: nock and draw; releasing shoots. */
  readonly pressed: boolean;
  /** true: put the arrow back. */
  readonly cancelled: boolean;
}

/** Half-life of the aim [s], because a mouse jumps and arms do not. */
const aimHalfLife = 0.06;
const nockSeconds = 0.4;
const grabSeconds = 0.12;
const drawSeconds = 0.9;
const looseSeconds = 0.1;
const followSeconds = 0.25;
const returnSeconds = 0.45;

type Phase = 'ready' | 'nocking' | 'grabbing' | 'drawing' | 'loosing' | 'following' | 'returning' | 'lowering';

/**
 * An archer that is steered by a pointer instead of two hands. Creates an archer at the centre of the zone, with the
 * postures of the built-in archer.
 */
export function createSteeredArcher(body: ArcherBody) {
  const postures = new ArcherPostures(body);
  const { eyes } = postures;
  let phase: Phase = 'ready';
  let began = 0;
  let last: number | null = null;
  let aim: Vec3 | null = null;
  let fullDraw = 0;
  /** Share of the full draw at the release, or when the arrow was cancelled. */
  let share = 0;
  /** How far the string of a cancelled arrow was eased in the last frame, 0 to 1: no slow frame may let go before. */
  let eased = 0;
  /** The posture from which the hands return. */
  let left: Posture | null = null;

  function enter(next: Phase, time: number): void {
    phase = next;
    began = time;
  }

  return {
    /** The draw at which the string is at the anchor [m]; 0 before the first frame. */
    get fullDraw(): number {
      return fullDraw;
    },
    /** The hands return from a shot, and a press is not heeded yet. */
    get isRecovering(): boolean {
      return phase === 'loosing' || phase === 'following' || phase === 'returning' || phase === 'lowering';
    },
    /** Returns head, hands (floor frame) and buttons at `time` [s, not decreasing]. */
    follow(time: number, { target, pressed, cancelled }: Steering): SimulatedInput {
      aim = aim === null || last === null ? target : dampVec3(aim, target, aimHalfLife, time - last);
      last = time;
      const taking = postures.ready(yawOf(subtract(aim, eyes)));
      const nocking: Posture = { ...taking, onString: 1 };
      const full = postures.drawn(aim);
      fullDraw = full.hold.draw;
      const done = (seconds: number): number => minimumJerk(clamp((time - began) / seconds, 0, 1));
      const over = (seconds: number): boolean => time - began >= seconds;

      if (phase === 'ready' && pressed) enter('nocking', time);
      else if (phase === 'nocking' && over(nockSeconds)) enter('grabbing', time);
      else if (phase === 'grabbing' && over(grabSeconds)) {
        share = 0;
        enter('drawing', time);
      } else if (phase === 'drawing') {
        share = done(drawSeconds);
        eased = 0;
        if (cancelled) enter('lowering', time);
        else if (!pressed) enter('loosing', time);
      } else if (phase === 'lowering' && eased === 1) {
        left = nocking;
        enter('returning', time);
      } else if (phase === 'loosing' && over(looseSeconds)) enter('following', time);
      else if (phase === 'following' && over(followSeconds)) {
        left = postures.followedThrough(mixPostures(nocking, full, share));
        enter('returning', time);
        // A new shot begins with a new press.
      } else if (phase === 'returning' && over(returnSeconds) && !pressed) enter('ready', time);

      const bent = mixPostures(nocking, full, share);
      switch (phase) {
        case 'nocking':
          return postures.inputFor(mixPostures(taking, nocking, done(nockSeconds)), time, 0, 0);
        case 'grabbing':
          return postures.inputFor(nocking, time, done(grabSeconds), 0);
        case 'drawing':
          return postures.inputFor(bent, time, 1, 0);
        case 'lowering':
          eased = done(returnSeconds);
          return postures.inputFor(mixPostures(nocking, full, share * (1 - eased)), time, 1, 0);
        case 'loosing':
          return postures.inputFor(bent, time, 1 - done(looseSeconds), 0);
        case 'following':
          return postures.inputFor(mixPostures(bent, postures.followedThrough(bent), done(followSeconds)), time, 0, 0);
        case 'returning':
          return postures.inputFor(mixPostures(left ?? taking, taking, done(returnSeconds)), time, 0, 0);
        default:
          return postures.inputFor(taking, time, 0, 0);
      }
    },
  };
}

export type SteeredArcher = ReturnType<typeof createSteeredArcher>;
