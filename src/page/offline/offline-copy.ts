import { reasonOf } from 'threepoint/core';
import { pageFolder } from 'threepoint-ui';

/**
 * This browser's copy of the page for use without a network: none, loading, complete, or the reason why there is none.
 */
type OfflineCopyState = 'nothing' | 'coming' | 'whole' | { readonly refused: string };

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

/** Stores a copy of the page in this browser, so that later visits need no network. */
export class OfflineCopy {
  #state: OfflineCopyState = 'nothing';

  get state(): OfflineCopyState {
    return this.#state;
  }

  /**
   * Stores the page or its newer version. The state reports a browser that cannot store it (no secure context, a
   * private window, full storage, a policy). Never rejects.
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
