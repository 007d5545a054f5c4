import { Worker } from 'node:worker_threads';
import type { ExportContent } from './study-export';
import type { PackedMotion } from './study-motion';

/** What an export is made of, recordings as they are stored. */
export interface Exported {
  readonly content: Omit<ExportContent, 'motion'> & { readonly motion: readonly PackedMotion[] };
  /** Of one participant alone; undefined: of the study. */
  readonly participant?: string | undefined;
}

/** A zip made in a thread of its own: of a study with recordings it takes many seconds, in which others are served. */
function zipInThread(exported: Exported): Promise<Uint8Array> {
  const script = new URL('./study-export-worker.mjs', import.meta.url);
  const worker = new Worker(script, { workerData: exported, execArgv: [] });
  // A server that ends waits for no export.
  worker.unref();
  return new Promise((resolve, reject) => {
    worker.once('message', resolve);
    worker.on('error', reject);
    worker.once('exit', () => reject(new Error('the thread of an export ended without one')));
  });
}

/** Makes exports one after the other, so that many at once take no more memory and no more processors than one. */
export function createExporter(): (read: () => Exported) => Promise<Uint8Array> {
  let last: Promise<void> = Promise.resolve();
  return (read) => {
    const zip = last.then(() => zipInThread(read()));
    // The next one neither keeps these bytes nor fails for what failed here, which is told to the one who asked for it.
    const over = () => undefined;
    last = zip.then(over, over);
    return zip;
  };
}
