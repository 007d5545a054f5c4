import { ConfigurationError } from 'threepoint-http';

export type Environment = Readonly<Record<string, string | undefined>>;

/** Returns the ConfigurationError of a variable with a wrong value; `must`: what it has to be. */
export const invalidVariable = (name: string, must: string, found: string): Error =>
  new ConfigurationError(`The environment variable ${name} must ${must}, not "${found}".`);

/** Returns the parts of a list that is separated by commas. */
export const splitList = (text = ''): readonly string[] =>
  text
    .split(',')
    .map((part) => part.trim())
    .filter(Boolean);
