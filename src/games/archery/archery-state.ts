import type { Quat } from 'threepoint/core/math/quat';
import type { RandomState } from 'threepoint/core/math/random';
import type { Vec3 } from 'threepoint/core/math/vec3';

/** What may differ between matches. */
export interface ArcheryOptions {
  readonly arrows: number;
  /** Seconds from the first release or the start signal until the bell. */
  readonly seconds: number;
  /** true: a target scores with every hit; false: once. */
  readonly everyHitCounts: boolean;
  /** What makes the clock run: the first arrow or the start signal, whichever is first, or the signal alone. No arrow flies before it. */
  readonly startedBy: 'arrow' | 'signal';
  /** Targets at the same angular height for an archer whose eyes are this high above the floor [m]. */
  readonly eyeHeight: number;
}

/** A disc that faces the archer. Arena frame: the archer's zone lies about the origin, the range ahead along −Z. */
export interface Target {
  readonly centre: Vec3;
  /** Unit, out of the painted side. */
  readonly normal: Vec3;
  readonly radius: number;
  /** Along the floor from the origin [m]. */
  readonly distance: number;
  readonly points: number;
}

/** Where an arrow ended its flight. */
export interface Landing {
  /** Seconds of the match. */
  readonly time: number;
  /** Of the tip. */
  readonly position: Vec3;
  /** Unit: how the arrow flew at the end. */
  readonly direction: Vec3;
  readonly on: 'target' | 'ground' | 'wall';
  /** Index of the target hit; null elsewhere. */
  readonly target: number | null;
  /** What it scored; 0 for a target that had scored already. */
  readonly points: number;
}

/** An arrow shot: its flight follows in closed form from the release. */
export interface Arrow {
  readonly id: number;
  readonly release: {
    /** Seconds of the match. */
    readonly time: number;
    /** Of the tip. */
    readonly position: Vec3;
    /** Metres per second. */
    readonly velocity: Vec3;
  };
  readonly landing: Landing | null;
}

/** Why a round is over: every arrow shot and landed, every target scored, or the bell. */
export type RoundEnd = 'arrows' | 'targets' | 'time';

export interface ArcheryState {
  readonly options: ArcheryOptions;
  readonly random: RandomState;
  /** Ticks since the start. */
  readonly tick: number;
  /** ready: waits for the start signal; the clock stands. */
  readonly phase: 'ready' | 'running' | 'over';
  readonly end: RoundEnd | null;
  readonly score: number;
  readonly arrowsLeft: number;
  readonly targets: readonly Target[];
  /** Arrows shot, in order. */
  readonly arrows: readonly Arrow[];
  /** Where the archer's head was last, arena frame; before the first word of it: over the origin. */
  readonly head: Vec3;
  /** Whether the archer's head is above the zone. Coming back counts a little inside its edge, so that the edge does not flicker. */
  readonly inZone: boolean;
}

export type ArcheryAction =
  | { readonly type: 'start' }
  /** Where the archer's head is; ignored unless finite and within 50 m. */
  | { readonly type: 'stand'; readonly head: Vec3 }
  | {
      readonly type: 'release';
      /** Of the tip, arena frame. */
      readonly position: Vec3;
      /** Unit. */
      readonly direction: Vec3;
      /** Draw length beyond brace height [m]. */
      readonly draw: number;
      /** Seconds into this tick, in [0, tickSeconds): frames and ticks need not coincide. */
      readonly delay: number;
    };

export type ArcheryEvent =
  | { readonly type: 'started' }
  | { readonly type: 'released'; readonly arrow: Arrow }
  | { readonly type: 'landed'; readonly arrow: Arrow; readonly landing: Landing }
  | { readonly type: 'left-zone' }
  | { readonly type: 'entered-zone' }
  | { readonly type: 'ended'; readonly end: RoundEnd; readonly score: number };

/** What the hands do with the bow right now, for those who draw it, in the frame of the tracked poses (floor). */
export interface BowView {
  readonly bowSide: 'left' | 'right';
  /** Grip of the bow; −Z to the target, +Y along the upper limb. */
  readonly bow: { readonly position: Vec3; readonly orientation: Quat };
  /** Where the middle of the string is. */
  readonly nockPoint: Vec3;
  /** Draw length beyond brace height [m]; 0: at rest. */
  readonly draw: number;
  readonly stage: 'empty' | 'nocked' | 'drawing' | 'anchored' | 'held';
  /** The arrow on the string: nock and unit direction; null: none. */
  readonly arrow: { readonly nock: Vec3; readonly direction: Vec3 } | null;
}
