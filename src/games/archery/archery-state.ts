import type { Quat, Vec3 } from 'threepoint/math';

export interface ArcheryOptions {
  readonly arrows: number;
  /** Seconds from the first release or the start signal until the bell. */
  readonly seconds: number;
  /** true: a target scores with every hit; false: only once. */
  readonly everyHitCounts: boolean;
  /**
   * What starts the clock: the first arrow or the start signal, or the signal alone. No arrow flies before the start.
   */
  readonly startedBy: 'arrow' | 'signal';
  /** Eye height of the archer above the floor [m], by which the targets are placed. */
  readonly eyeHeight: number;
}

/** A disc that faces the archer. Arena frame: the archer's zone lies about the origin, the range ahead along −Z. */
export interface Target {
  readonly centre: Vec3;
  /** Normal of the painted side, unit. */
  readonly normal: Vec3;
  readonly radius: number;
  /** Distance along the floor from the origin [m]. */
  readonly distance: number;
  readonly points: number;
}

/** The end of an arrow's flight. */
export interface Landing {
  /** Time of the match [s]. */
  readonly time: number;
  /** Position of the tip [m]. */
  readonly position: Vec3;
  /** Direction of flight at the end, unit. */
  readonly direction: Vec3;
  readonly on: 'target' | 'ground' | 'wall';
  /** Index of the target hit; null elsewhere. */
  readonly target: number | null;
  /** Points scored; 0 for a target that has scored before. */
  readonly points: number;
}

/** An arrow shot: its flight follows in closed form from the release. */
export interface Arrow {
  readonly id: number;
  readonly release: {
    /** Time of the match [s]. */
    readonly time: number;
    /** Position of the tip [m]. */
    readonly position: Vec3;
    /** Velocity [m/s]. */
    readonly velocity: Vec3;
  };
  readonly landing: Landing | null;
}

/** Why a round is over: every arrow has landed, every target has scored, or the bell has rung. */
export type RoundEnd = 'arrows' | 'targets' | 'time';

export interface ArcheryState {
  readonly options: ArcheryOptions;
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
  /** The archer's last head position, arena frame; above the origin before the first one. */
  readonly head: Vec3;
  /** Whether the archer's head is above the zone; it re-enters slightly inside the edge, which avoids flicker. */
  readonly inZone: boolean;
}

export type ArcheryAction =
  | { readonly type: 'start' }
  /** The archer's head position; ignored unless finite and within 50 m. */
  | { readonly type: 'stand'; readonly head: Vec3 }
  | {
      readonly type: 'release';
      /** Position of the tip, arena frame [m]. */
      readonly position: Vec3;
      /** Direction of the arrow, unit. */
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

/** The bow as it is drawn in a frame, in the floor frame. */
export interface BowView {
  readonly bowSide: 'left' | 'right';
  /** Grip of the bow; −Z to the target, +Y along the upper limb. */
  readonly bow: { readonly position: Vec3; readonly orientation: Quat };
  /** The middle of the string. */
  readonly nockPoint: Vec3;
  /** Draw length beyond brace height [m]; 0: at rest. */
  readonly draw: number;
  readonly stage: 'empty' | 'nocked' | 'drawing' | 'anchored' | 'held';
  /** The arrow on the string: nock and unit direction; null: none. */
  readonly arrow: { readonly nock: Vec3; readonly direction: Vec3 } | null;
}
