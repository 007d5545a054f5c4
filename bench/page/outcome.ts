import { installTrustedTypesPolicy } from 'threepoint-ui';

declare global {
  interface Window {
    /** The outcome of a bench page's work; absent: the work goes on. */
    benchOutcome?: { readonly result: unknown } | { readonly error: string };
  }
}

/** Does the work of this page, and leaves its result or its error for the bench. */
export async function reportOutcome(work: () => Promise<unknown>): Promise<void> {
  try {
    // The browser refuses the build's workers otherwise.
    installTrustedTypesPolicy();
    window.benchOutcome = { result: await work() };
  } catch (error) {
    window.benchOutcome = { error: error instanceof Error ? (error.stack ?? error.message) : String(error) };
  }
}
