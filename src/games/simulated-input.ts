import type { Buttons, TrackingFrame } from 'threepoint/core';

/** Head, hands and buttons of a simulated player at one moment: new objects in every frame. */
export interface SimulatedInput {
  readonly frame: TrackingFrame;
  readonly buttons: Buttons;
}
