import type { StageParts } from '../stage/stage-parts';
import type { Pointers } from './pointers';
import type { TrackingSource } from './tracking-source';

/** The parts of the page that its panels, the steps of a frame and the probe are built on. */
export interface InputParts extends StageParts {
  readonly pointers: Pointers;
  readonly source: TrackingSource;
}
