import { reasonOf } from 'threepoint/core/errors/reasons';
import type { PlayedStep } from '../../model/plan/schedule';

/** How far the game and the body of a step are loaded. */
export interface Prepared {
  readonly state: 'loading' | 'ready' | 'failed';
  /** Why loading failed, in a sentence; otherwise empty. */
  readonly reason: string;
}

/** Loads the game and the body of one attempt after another; results of earlier attempts are ignored. */
export class TrialPreparation {
  readonly #load: (step: PlayedStep) => Promise<void>;
  readonly #onChange: () => void;
  #attempt: string | null = null;
  #prepared: Prepared | null = null;

  /** `load` rejects with a sentence; `onChange` is called when it has succeeded or failed. */
  constructor(load: (step: PlayedStep) => Promise<void>, onChange: () => void) {
    this.#load = load;
    this.#onChange = onChange;
  }

  /** Returns the state of the attempt with this key, or null if it was not requested. */
  of(attempt: string): Prepared | null {
    return this.#attempt === attempt ? this.#prepared : null;
  }

  async begin(attempt: string, step: PlayedStep): Promise<void> {
    const loading: Prepared = { state: 'loading', reason: '' };
    this.#attempt = attempt;
    this.#prepared = loading;
    let outcome: Prepared;
    try {
      await this.#load(step);
      outcome = { state: 'ready', reason: '' };
    } catch (error) {
      outcome = { state: 'failed', reason: reasonOf(error) };
    }
    if (this.#prepared !== loading) return;
    this.#prepared = outcome;
    this.#onChange();
  }

  /** Discards the state, so that everything is loaded again. */
  forget(): void {
    this.#attempt = null;
    this.#prepared = null;
  }
}
