import { reasonOf } from 'threepoint/core/errors/reasons';
import type { PlayedStep } from './study-trial';

/** How far the game and the body of a step are. */
export interface Prepared {
  readonly state: 'loading' | 'ready' | 'failed';
  /** Why it failed, for a person to read; else empty. */
  readonly reason: string;
}

/** Gets one attempt after the other ready to be played; what an earlier one still loads no longer counts. */
export class TrialPreparation {
  readonly #load: (step: PlayedStep) => Promise<void>;
  readonly #onChange: () => void;
  #attempt: string | null = null;
  #prepared: Prepared | null = null;

  /** `load` rejects with a sentence; `onChange` hears when it succeeded or failed. */
  constructor(load: (step: PlayedStep) => Promise<void>, onChange: () => void) {
    this.#load = load;
    this.#onChange = onChange;
  }

  /** Of the attempt with this key; null: not asked for yet. */
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

  /** What is prepared, or was to be, is to be loaded again. */
  forget(): void {
    this.#attempt = null;
    this.#prepared = null;
  }
}
