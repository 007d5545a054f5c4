import { reasonOf } from '../../core/errors/reasons';
import type { PlayedStep } from './study-trial';

/** How far the game and the body of a step are. */
export interface Prepared {
  readonly state: 'loading' | 'ready' | 'failed';
  /** Why it failed, for a person to read; else empty. */
  readonly reason: string;
}

/** Gets one step after the other ready to be played; what an earlier step still loads no longer counts. */
export class TrialPreparation {
  readonly #load: (step: PlayedStep) => Promise<void>;
  readonly #onChange: () => void;
  #step: string | null = null;
  #prepared: Prepared | null = null;

  /** `load` rejects with a sentence; `onChange` hears when it succeeded or failed. */
  constructor(load: (step: PlayedStep) => Promise<void>, onChange: () => void) {
    this.#load = load;
    this.#onChange = onChange;
  }

  /** Of the step with this id; null: not asked for yet. */
  of(step: string): Prepared | null {
    return this.#step === step ? this.#prepared : null;
  }

  async begin(step: PlayedStep): Promise<void> {
    const loading: Prepared = { state: 'loading', reason: '' };
    this.#step = step.id;
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
    this.#step = null;
    this.#prepared = null;
  }
}
