/** What the user tells us, or two seconds of standing still reveal, about their body. */
export interface Calibration {
  /** Height [m] of the headset's origin (between the eyes) above the floor, standing upright and looking ahead. */
  readonly eyeHeight: number;
  /** Distance [m] from wrist to wrist, arms stretched out sideways. */
  readonly armSpan: number;
}
