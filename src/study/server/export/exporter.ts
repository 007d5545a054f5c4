import { type ChildProcess, spawn } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import type { Software } from 'threepoint-http/software';
import { shortageOf } from 'threepoint-http/thread-calls';
import { StoreRefusal } from '../storage/database';

/** What an export is asked for; its process reads the content from the database. */
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
/** How much of what a process writes about its end is read [characters]. */
const mostComplaint = 10_000;

function started(file: string, order: ExportOrder): ChildProcess {
  const script = fileURLToPath(new URL('./study-export-worker.mjs', import.meta.url));
  return spawn(process.execPath, [script, file, JSON.stringify(order)], { stdio: ['ignore', 'pipe', 'pipe'] });
}

/**
 * A zip made in a process of its own. Of a study with recordings it takes many seconds and much memory: a thread that runs out of memory
 * within SQLite's driver ends the whole process, and rooms with it.
 */
function zipInProcess(file: string, order: ExportOrder): Promise<Uint8Array> {
  const child = started(file, order);
  const chunks: Buffer[] = [];
  let complaint = '';
  child.stdout?.on('data', (chunk: Buffer) => chunks.push(chunk));
  child.stderr?.on('data', (chunk: Buffer) => {
    complaint = `${complaint}${chunk}`.slice(-mostComplaint);
  });
  return new Promise((resolve, reject) => {
    const fail = (error: Error) => {
      const shortage = shortageOf(error);
      reject(
        shortage === null ? error : new StoreRefusal('full', `${shortage} Or export the participants one by one.`),
      );
    };
    child.once('error', fail);
    child.once('close', (code, signal) => {
      if (code === 0) resolve(new Uint8Array(Buffer.concat(chunks)));
      else fail(new Error(`the process of an export ended with ${code ?? signal}: ${complaint}`));
    });
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
    const zip = last.then(() => zipInProcess(file, order)).finally(() => (waiting -= 1));
    // The next one neither keeps these bytes nor fails for what failed here, which its own caller receives.
    const over = () => undefined;
    last = zip.then(over, over);
    return zip;
  };
}
