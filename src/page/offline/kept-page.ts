import { reasonOf } from 'threepoint/core/errors/reasons';
import { pageFolder } from 'threepoint-ui/page-folder';

/** What this browser has of the page for a visit without a network: nothing yet, a copy on its way, a whole copy; or why it keeps none. */
export type KeptState = 'nothing' | 'coming' | 'whole' | { readonly refused: string };

/** Resolves when the worker has its files, or never will. */
function settled(worker: ServiceWorker): Promise<void> {
  return new Promise((resolve) => {
    const look = () => {
      if (worker.state === 'installing') return;
      worker.removeEventListener('statechange', look);
      resolve();
    };
    worker.addEventListener('statechange', look);
    look();
  });
}

/** The copy of the page that this browser keeps, so that the next visit needs no network. */
export class KeptPage {
  #state: KeptState = 'nothing';

  get state(): KeptState {
    return this.#state;
  }

  /**
   * Brings the copy, or a newer one beside it. A browser that keeps nothing (no secure context, a private window, full storage, a policy)
   * leaves the page as it is. Never rejects.
   */
  async keep(workers: ServiceWorkerContainer | undefined): Promise<void> {
    if (!workers) {
      this.#state = { refused: 'this browser does not support service workers here' };
      return;
    }
    this.#state = 'coming';
    try {
      const { active, installing } = await workers.register(`${pageFolder()}/sw.js`);
      if (!active && installing) await settled(installing);
      const whole = active !== null || installing?.state !== 'redundant';
      this.#state = whole ? 'whole' : { refused: 'the files could not be stored' };
    } catch (error) {
      this.#state = { refused: reasonOf(error) };
    }
  }
}
