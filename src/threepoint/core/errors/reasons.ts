/** The reason behind anything that was thrown, as a sentence. */
export function reasonOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** What fits into a notice: stacks and long reports begin below it. */
export const firstLine = (text: string): string => text.split('\n')[0] ?? text;
