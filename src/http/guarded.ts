/**
 * Returns a handler of an event that never throws: `onFault` receives its exceptions, which would end the process, and
 * its arguments.
 */
export const guarded =
  <Args extends unknown[]>(handle: (...args: Args) => void, onFault: (error: unknown, ...args: Args) => void) =>
  (...args: Args): void => {
    try {
      handle(...args);
    } catch (error) {
      onFault(error, ...args);
    }
  };
