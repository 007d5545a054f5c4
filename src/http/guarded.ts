/**
 * Returns a handler of an event that never throws: `onError` receives its exceptions, which would end the process, and
 * its arguments.
 */
export const guarded =
  <Args extends unknown[]>(handle: (...args: Args) => void, onError: (error: unknown, ...args: Args) => void) =>
  (...args: Args): void => {
    try {
      handle(...args);
    } catch (error) {
      onError(error, ...args);
    }
  };
