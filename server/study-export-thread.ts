import type { Software } from './software';
import { StoreRefusal } from './study-database';
import { shortageOf, startThread } from './thread-calls';

/** What an export is asked for; the thread reads its content from the database. */
export interface ExportOrder {
  /** Seconds since 1970. */
  readonly at: number;
  readonly study: string;
  /** Version of the plan; only a whole study is restricted to those who follow it. */
  readonly version: number;
  /** One participant alone; undefined: the study. */
  readonly participant?: string;
  readonly software: Software;
}

/** Makes the zip of an export; rejects with a StoreRefusal where too many wait for theirs, or where memory or files do not suffice. */
export type Exporter = (order: ExportOrder) => Promise<Uint8Array>;

/** Exports that wait for the one that is being made: each holds a connection and an answer. */
const mostWaiting = 8;

/** A zip made in a thread of its own: of a study with recordings it takes many seconds, in which others are served. */
function zipInThread(file: string, order: ExportOrder): Promise<Uint8Array> {
  const worker = startThread(new URL('./study-export-worker.mjs', import.meta.url), { file, order });
  // A server that ends waits for no export.
  worker.unref();
  return new Promise((resolve, reject) => {
    worker.once('message', resolve);
    worker.on('error', (error: Error) => {
      const shortage = shortageOf(error);
      reject(
        shortage === null ? error : new StoreRefusal('full', `${shortage} Or export the participants one by one.`),
      );
    });
    worker.once('exit', () => reject(new Error('the thread of an export ended without one')));
  });
}

/** Makes exports of this database one after the other, so that many at once take no more memory and no more processors than one. */
export function createExporter(file: string): Exporter {
  let last: Promise<unknown> = Promise.resolve();
  let waiting = 0;
  return async (order) => {
    if (waiting >= mostWaiting) {
      throw new StoreRefusal('busy', `${waiting} exports are waiting already: ask again when they are made`);
    }
    waiting += 1;
    const zip = last.then(() => zipInThread(file, order)).finally(() => (waiting -= 1));
    // The next one neither keeps these bytes nor fails for what failed here, which its own caller receives.
    const over = () => undefined;
    last = zip.then(over, over);
    return zip;
  };
}
