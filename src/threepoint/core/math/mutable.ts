/** An object whose fields its owner overwrites. */
export type Mutable<T> = { -readonly [Key in keyof T]: T[Key] };
