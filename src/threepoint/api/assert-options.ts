/**
 * Throws a TypeError if options are missing or one has an unknown name: a misspelt option would have no effect. `of`:
 * the name of the function or class. `internal`: options that no message names.
 */
export function assertOptions(
  of: string,
  options: object | null | undefined,
  known: readonly string[],
  internal: readonly string[] = [],
): void {
  if (typeof options !== 'object' || options === null) {
    throw new TypeError(`${of} needs an object of options. Use ${known.join(', ')}.`);
  }
  const unknown = Object.keys(options).find((name) => !known.includes(name) && !internal.includes(name));
  if (unknown === undefined) return;
  throw new TypeError(`“${unknown}” is not an option of ${of}. Use ${known.join(', ')}.`);
}

/** Returns the names of all options of a type, which the compiler compares with the type. */
export const optionNames = <Options extends object>(names: Record<keyof Required<Options>, true>): readonly string[] =>
  Object.keys(names);
