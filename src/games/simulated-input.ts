import type { Buttons } from 'threepoint/core/input/button-presses';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';

/** Head, hands and buttons of a simulated player at one moment: new objects in every frame. */
export interface SimulatedInput {
  readonly frame: TrackingFrame;
  readonly buttons: Buttons;
}
