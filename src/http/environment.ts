import { ConfigurationError } from './configuration-error';

/** Returns the ConfigurationError of a variable with a wrong value; `must`: what it has to be. */
export const invalidVariable = (name: string, must: string, found: string): Error =>
  new ConfigurationError(`The environment variable ${name} must ${must}, not "${found}".`);

/** Returns the parts of a list that is separated by commas. */
export const splitList = (text = ''): readonly string[] =>
  text
    .split(',')
    .map((part) => part.trim())
    .filter(Boolean);

/** Returns the number in a variable, or `fallback` if it is not set. Throws a ConfigurationError outside [min, max]. */
export function numberFrom(
  environment: NodeJS.ProcessEnv,
  name: string,
  fallback: number,
  min: number,
  max: number,
): number {
  const text = environment[name];
  if (text === undefined || text === '') return fallback;
  const value = Number(text);
  if (!(value >= min && value <= max)) throw invalidVariable(name, `be a number from ${min} to ${max}`, text);
  return value;
}
