declare global {
  interface Window {
    /** What came of the work of a page of the bench; absent: it goes on. */
    benchOutcome?: { readonly result: unknown } | { readonly error: string };
  }
}

/** Tells the bench what comes of the work of this page. */
export async function tellOutcome(work: Promise<unknown>): Promise<void> {
  try {
    window.benchOutcome = { result: await work };
  } catch (error) {
    window.benchOutcome = { error: error instanceof Error ? (error.stack ?? error.message) : String(error) };
  }
}
