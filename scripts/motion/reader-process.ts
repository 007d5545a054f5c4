import { type ChildProcess, fork } from 'node:child_process';
import { join } from 'node:path';
import type { MocapClip, MocapSource } from 'threepoint/internal';
import type { ReadMocap } from '../../src/threepoint/core/mocap/prepare-mocap';

/** A file of motion or of an avatar, with what its format needs. */
export interface FileBytes extends Pick<MocapSource, 'name' | 'map' | 'rest' | 'rateHz'> {
  readonly bytes: ArrayBuffer;
  /** The skeleton of an AMC file. */
  readonly skeleton?: NonNullable<MocapSource['map']>;
}

/** The ways in which the process reads a file. */
export interface ReaderApi {
  /** Returns what a headset and two hands would have seen. */
  clips(file: FileBytes): Promise<readonly MocapClip[]>;
  /** Returns the motion with its ground truth. */
  truth(file: FileBytes): Promise<ReadMocap>;
  /** Returns an avatar that has passed the check of the page, as GLB. */
  avatar(file: FileBytes): Promise<ArrayBuffer>;
}

export type ReaderResponse = { readonly read: unknown } | { readonly refused: string };

const root = join(import.meta.dirname, '../..');

/**
 * Reads files of other people in a process of limited memory, one at a time, as the page does in a worker. A thread is
 * no protection: Node ends all threads when a list of one of them grows beyond its limit.
 */
export class FileReaderProcess {
  readonly #megabytes: number;
  #process: ChildProcess | null = null;

  /** `megabytes`: the memory of the process; by default that of a page on a headset. */
  constructor(megabytes = 1024) {
    this.#megabytes = megabytes;
  }

  /** Reads a file. Rejects with a sentence that names the file. */
  read<Call extends keyof ReaderApi>(call: Call, file: FileBytes): ReturnType<ReaderApi[Call]> {
    this.#process ??= fork(join(import.meta.dirname, 'reader-main.ts'), {
      cwd: root,
      execArgv: ['--import', 'tsx', `--max-old-space-size=${this.#megabytes}`],
      serialization: 'advanced',
      stdio: ['ignore', 'ignore', 'ignore', 'ipc'],
    });
    const reader = this.#process;
    const answer = new Promise((resolve, reject) => {
      reader.once('message', (message: ReaderResponse) => {
        if ('read' in message) resolve(message.read);
        else reject(new Error(message.refused));
      });
      reader.once('exit', (code, signal) => {
        this.#process = null;
        const isMemory = signal === 'SIGABRT' || code === 134;
        const reason = isMemory
          ? `needs more than ${this.#megabytes} MB of memory; open a smaller file`
          : `the process that reads it ended (${signal ?? code})`;
        reject(new Error(`${file.name}: ${reason}`));
      });
      reader.send({ call, file });
    });
    return answer.finally(() => reader.removeAllListeners()) as ReturnType<ReaderApi[Call]>;
  }

  [Symbol.dispose](): void {
    this.#process?.kill('SIGKILL');
    this.#process = null;
  }
}
