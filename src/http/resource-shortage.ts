/**
 * Returns a sentence about the resource that a thread or process ran out of, and what to do; null: the error has
 * another cause.
 */
export function shortageOf(error: Error): string | null {
  const text = `${(error as NodeJS.ErrnoException).code} ${error.message}`;
  if (/\b(EMFILE|ENFILE)\b/.test(text)) {
    return 'The server has too many files open. Raise the limit: ulimit -n 1024.';
  }
  if (!/ERR_WORKER_OUT_OF_MEMORY|ERR_WORKER_INIT_FAILED|\bENOMEM\b|out of memory/i.test(text)) return null;
  return 'The server is out of memory. Give it more: NODE_OPTIONS=--max-old-space-size=512.';
}
