import { isNightly } from '../nightly';

/** Returns how many mutated files of a format are read: `byDay`, 100,000 at night, or what MUTATED_FILES states. */
export const mutatedFiles = (byDay: number): number =>
  Number(process.env.MUTATED_FILES ?? (isNightly ? 100_000 : byDay));

/** The seed of the mutations; MUTATED_SEED states another. */
export const mutationSeed = Number(process.env.MUTATED_SEED ?? 20261127);

/** A smaller file counts as this many bytes: what a reader allocates for any file is no multiple of it. */
const minBytes = 65_536;

const arrayBuffers = (): number => process.memoryUsage().arrayBuffers;

/** The largest costs of the files that were read one after another. */
export class ReadingCosts {
  /** Time of the processor [ms]: other programs of the machine do not count. */
  longestMs = 0;
  /** Growth of all array buffers while one file is read, as a multiple of its size (`minBytes` at least). */
  largestMultiple = Number.NEGATIVE_INFINITY;
  readonly #collectGarbage: (() => void) | undefined;
  /** What is held before any file is read [bytes]. */
  readonly #held: number;
  /** The largest multiple with garbage. */
  #maxAllocated = Number.NEGATIVE_INFINITY;

  /**
   * `collectGarbage`: of every file that leaves more garbage than those before it, only what is held after a collection
   * counts as memory; absent: garbage counts, too.
   */
  constructor(collectGarbage?: () => void) {
    this.#collectGarbage = collectGarbage;
    collectGarbage?.();
    this.#held = arrayBuffers();
  }

  /** Reads a file of this size and returns the result, or the error that was thrown. */
  async measure<T>(fileBytes: number, read: () => T | Promise<T>): Promise<T | Error> {
    const before = this.#collectGarbage ? this.#held : arrayBuffers();
    const started = process.cpuUsage();
    try {
      return await read();
    } catch (error) {
      if (error instanceof Error) return error;
      throw error;
    } finally {
      const { user, system } = process.cpuUsage(started);
      this.longestMs = Math.max(this.longestMs, (user + system) / 1000);
      const multiple = () => (arrayBuffers() - before) / Math.max(fileBytes, minBytes);
      const allocated = multiple();
      if (allocated > this.#maxAllocated) {
        this.#maxAllocated = allocated;
        this.#collectGarbage?.();
        this.largestMultiple = Math.max(this.largestMultiple, multiple());
      }
    }
  }

  /** The figures for docs/reliability.md. */
  figures(format: string): Record<string, number> {
    return {
      [`longest work on one ${format} [ms of the processor]`]: this.longestMs,
      [`most memory for one ${format} [× the file]`]: this.largestMultiple,
    };
  }
}

/** Random choices by numbers in [0, 1). */
export function choicesBy(chance: () => number) {
  const below = (end: number): number => Math.floor(chance() * end);
  return {
    below,
    oneOf: <T>(values: readonly T[]): T => values[below(values.length)]!,
    /** Flips so many bits of the bytes. */
    flipBits(bytes: Uint8Array, count: number): void {
      for (let i = count; i > 0; i--) bytes[below(bytes.length)]! ^= 1 << below(8);
    },
  };
}

/** The objects and lists of a value, at any depth. */
export function containersIn(value: unknown): (Record<string, unknown> | unknown[])[] {
  if (typeof value !== 'object' || value === null) return [];
  return [value as Record<string, unknown>, ...Object.values(value).flatMap(containersIn)];
}
