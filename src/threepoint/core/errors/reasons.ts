/** Returns the reason behind any thrown value, as a sentence. */
export function reasonOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** Returns the first line, which fits into a notice: stacks and long reports follow below it. */
export const firstLine = (text: string): string => text.split('\n')[0] ?? text;
