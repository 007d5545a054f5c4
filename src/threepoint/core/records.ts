/** An object whose fields its owner overwrites. */
export type Mutable<T> = { -readonly [Key in keyof T]: T[Key] };

/** Returns a record of these keys, each with its value. */
export const recordOf = <Key extends string, Value>(
  keys: readonly Key[],
  of: (key: Key, index: number) => Value,
): Record<Key, Value> => Object.fromEntries(keys.map((key, index) => [key, of(key, index)])) as Record<Key, Value>;
