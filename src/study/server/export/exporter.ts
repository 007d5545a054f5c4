import { type ChildProcess, spawn } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { type Software, shortageOf } from 'threepoint-http';
import { Rejection } from '../../model/progress/rejection';

/** The parameters of an export, whose process reads the content from the database. */
export interface ExportOrder {
  /** Seconds since 1970. */
  readonly at: number;
  readonly study: string;
  /** The version of the plan; the export of a whole study has only the participants who follow it. */
  readonly version: number;
  /** The only participant of the export; undefined: the whole study. */
  readonly participant?: string;
  readonly software: Software;
}

/**
 * Makes the zip file of an export; rejects with a Rejection if too many exports wait, or without enough memory or
 * files.
 */
export type Exporter = (order: ExportOrder) => Promise<Uint8Array>;

/** The most exports that wait for the present one. Each holds a connection and an answer. */
const maxWaiting = 8;
/** The most that is read of the error output of a process [characters]. */
const maxErrorOutput = 10_000;

function started(file: string, order: ExportOrder): ChildProcess {
  const script = fileURLToPath(new URL('./study-export-worker.mjs', import.meta.url));
  return spawn(process.execPath, [script, file, JSON.stringify(order)], { stdio: ['ignore', 'pipe', 'pipe'] });
}

/**
 * Makes a zip file in a separate process. An export with recordings takes many seconds and much memory, and a thread
 * that runs out of memory in SQLite's driver ends the whole process, with all rooms.
 */
function zipInProcess(file: string, order: ExportOrder): Promise<Uint8Array> {
  const child = started(file, order);
  const chunks: Buffer[] = [];
  let problem = '';
  child.stdout?.on('data', (chunk: Buffer) => chunks.push(chunk));
  child.stderr?.on('data', (chunk: Buffer) => {
    problem = `${problem}${chunk}`.slice(-maxErrorOutput);
  });
  return new Promise((resolve, reject) => {
    const fail = (error: Error) => {
      const shortage = shortageOf(error);
      reject(shortage === null ? error : new Rejection('full', `${shortage} Or export the participants one by one.`));
    };
    child.once('error', fail);
    child.once('close', (code, signal) => {
      if (code === 0) resolve(new Uint8Array(Buffer.concat(chunks)));
      else fail(new Error(`the process of an export ended with ${code ?? signal}: ${problem}`));
    });
  });
}

/** Makes exports of this database one after the other, so that many take no more memory and processors than one. */
export function createExporter(file: string): Exporter {
  let last: Promise<unknown> = Promise.resolve();
  let waiting = 0;
  return async (order) => {
    if (waiting >= maxWaiting) {
      throw new Rejection('busy', `${waiting} exports are waiting already. Try again in a few minutes`);
    }
    waiting += 1;
    const zip = last.then(() => zipInProcess(file, order)).finally(() => (waiting -= 1));
    // The next export neither keeps these bytes nor fails with this error, which its caller receives.
    const over = () => undefined;
    last = zip.then(over, over);
    return zip;
  };
}
