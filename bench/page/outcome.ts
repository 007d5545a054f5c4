import { allowOwnScripts } from 'threepoint-ui/own-scripts';

declare global {
  interface Window {
    /** What came of the work of a page of the bench; absent: it goes on. */
    benchOutcome?: { readonly result: unknown } | { readonly error: string };
  }
}

/** Does the work of this page; what comes of it is for the bench to read. */
export async function tellOutcome(work: () => Promise<unknown>): Promise<void> {
  try {
    // Workers of the build are refused without.
    allowOwnScripts();
    window.benchOutcome = { result: await work() };
  } catch (error) {
    window.benchOutcome = { error: error instanceof Error ? (error.stack ?? error.message) : String(error) };
  }
}
