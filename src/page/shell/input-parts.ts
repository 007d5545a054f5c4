import type { Pointers } from './frame/pointers';
import type { TrackingSource } from './frame/tracking-source';
import type { StageParts } from './stage-parts';

/** The parts of the page that its panels, the steps of a frame and the probe are built on. */
export interface InputParts extends StageParts {
  readonly pointers: Pointers;
  readonly source: TrackingSource;
}
