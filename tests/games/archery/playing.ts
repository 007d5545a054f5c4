import type { Buttons, TrackingFrame } from 'threepoint/core';
import { createMatch } from 'threepoint-games';
import {
  type ArcheryAction,
  type ArcheryEvent,
  ArcheryGestures,
  type ArcheryState,
  archeryRules,
  type BowCue,
  createSimulatedArcher,
  delayed,
  isArmed,
} from 'threepoint-games/archery';
import type { ArcherBody } from '../../../src/games/archery/archer-postures';
import type { ArcheryOptions } from '../../../src/games/archery/archery-state';
import { defaultArcheryGestureSettings, type GestureFrame } from '../../../src/games/archery/gestures';

/** What happened in a round that was played. */
export interface Round {
  readonly state: ArcheryState;
  readonly events: readonly ArcheryEvent[];
  readonly cues: readonly BowCue[];
  readonly frames: readonly TrackingFrame[];
  readonly gestures: readonly GestureFrame[];
  /** The actions of each tick. */
  readonly ticks: readonly (readonly ArcheryAction[])[];
}

export interface RoundPlan {
  readonly archer: ArcherBody;
  readonly seed?: number;
  readonly options?: Partial<ArcheryOptions>;
  /** Time of each frame [s]. */
  readonly times: Iterable<number>;
  /** What devices do to frames before the gestures see them. */
  readonly spoil?: (frame: TrackingFrame, buttons: Buttons) => { frame: TrackingFrame; buttons: Buttons };
}

/** Frame times at a rate, for this long, from a start that is not 0. */
export function* steady(rateHz: number, seconds = 70, start = 12.345): Generator<number> {
  for (let i = 0; i < seconds * rateHz; i++) yield start + i / rateHz;
}

/** The built-in archer plays a round through gestures, match and rules, until it is over or the times end. */
export function playRound({ archer: body, seed = 1, options = {}, times, spoil }: RoundPlan): Round {
  const start = archeryRules.start(['archer'], seed, { eyeHeight: body.eyeHeight, ...options });
  const ticks: (readonly ArcheryAction[])[] = [];
  const match = createMatch(archeryRules, start, { delayed, onTick: (actions) => ticks.push(actions) });
  const archer = createSimulatedArcher(body);
  const gestures = new ArcheryGestures(() => ({
    ...defaultArcheryGestureSettings,
    bowSide: body.bowSide,
    armed: isArmed(match.state),
  }));
  const round = { events: [], cues: [], frames: [], gestures: [] } as {
    events: ArcheryEvent[];
    cues: BowCue[];
    frames: TrackingFrame[];
    gestures: GestureFrame[];
  };
  for (const time of times) {
    const played = archer.follow(time, match.state);
    const { frame, buttons } = spoil ? spoil(played.frame, played.buttons) : played;
    // The gestures overwrite their result with every frame.
    const gesture = structuredClone(gestures.follow(frame, buttons));
    round.frames.push(frame);
    round.gestures.push(gesture);
    round.cues.push(...gesture.cues);
    round.events.push(...match.advance(time, gesture.actions));
    if (match.state.phase === 'over') break;
  }
  return { ...round, state: match.state, ticks };
}
