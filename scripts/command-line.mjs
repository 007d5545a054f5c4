import { parseArgs } from 'node:util';
import { SetupError, typedPath } from './run-command.mjs';

const options = (names, option) => Object.fromEntries(names.map((name) => [name, option]));

const fullPath = (value) => (Array.isArray(value) ? value.map(typedPath) : typedPath(value));

/**
 * Returns the options of an npm script by name, and its other arguments as `rest`. `texts`, `lists` and `flags` name
 * the options that take a value, may be repeated, and take none. `paths` names those whose values become full paths.
 * `rest`: what other arguments are, 'paths' or 'words'; absent: none are allowed.
 *
 * `check` throws what is wrong with them otherwise. Every fault becomes a SetupError with the usage.
 * @returns {Record<string, any>}
 */
export function readOptions(
  script,
  usage,
  { texts = [], paths = [], lists = [], flags = [], rest = undefined },
  check = (_) => undefined,
) {
  try {
    const { values, positionals } = parseArgs({
      options: {
        ...options([...texts, ...paths], { type: 'string' }),
        ...options(lists, { type: 'string', multiple: true }),
        ...options(flags, { type: 'boolean' }),
      },
      allowPositionals: rest !== undefined,
    });
    const given = { ...values, rest: rest === 'paths' ? fullPath(positionals) : positionals };
    for (const name of paths) if (given[name] !== undefined) given[name] = fullPath(given[name]);
    check(given);
    return given;
  } catch (error) {
    throw new SetupError(`${script}: ${error.message}\n${usage}`);
  }
}

/** Returns some options as arguments of another program. */
export const passedOn = (given, names) =>
  names.flatMap((name) =>
    [given[name] ?? []].flat().map((value) => (value === true ? `--${name}` : `--${name}=${value}`)),
  );
