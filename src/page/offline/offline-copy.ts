import { reasonOf } from 'threepoint/core/errors/reasons';
import { pageFolder } from 'threepoint-ui/page-folder';

/**
 * This browser's copy of the page for use without a network: none, loading, complete, or the reason why there is none.
 */
export type OfflineCopyState = 'nothing' | 'coming' | 'whole' | { readonly refused: string };

/** Resolves when the worker has installed its files, or has failed. */
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
export class OfflineCopy {
  #state: OfflineCopyState = 'nothing';

  get state(): OfflineCopyState {
    return this.#state;
  }

  /**
   * Stores a copy of the page, or a newer one. A browser that stores nothing (no secure context, a private window, full
   * storage, a policy) changes nothing. Never rejects.
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
