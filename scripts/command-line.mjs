import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, runProgram, SetupError, typedPath } from './run-command.mjs';

const options = (names, option) => Object.fromEntries(names.map((name) => [name, option]));

/**
 * Returns the options of an npm script by name, and its other arguments as `rest`. `texts`, `lists` and `flags` name
 * the options that take a value, may be repeated, and take none; `rest`: whether other arguments are allowed.
 *
 * `check` throws what is wrong with them otherwise. Every fault becomes a SetupError with the usage.
 * @returns {Record<string, any>}
 */
export function readOptions(
  script,
  usage,
  { texts = [], lists = [], flags = [], rest = false },
  check = (_) => undefined,
) {
  try {
    const { values, positionals } = parseArgs({
      options: {
        ...options(texts, { type: 'string' }),
        ...options(lists, { type: 'string', multiple: true }),
        ...options(flags, { type: 'boolean' }),
      },
      allowPositionals: rest,
    });
    const given = { ...values, rest: positionals };
    check(given);
    return given;
  } catch (error) {
    throw new SetupError(`${script}: ${error.message}\n${usage}`);
  }
}

/** Returns some options as arguments of another program; those named in `paths` with full paths. */
export const passedOn = (given, names, paths = []) =>
  [...names, ...paths].flatMap((name) =>
    [given[name] ?? []].flat().map((value) => {
      if (value === true) return `--${name}`;
      return `--${name}=${paths.includes(name) ? typedPath(value) : value}`;
    }),
  );

/** Is the whole of an npm script that runs a TypeScript program with these arguments, once all packages are there. */
export const runAsScript = (program, argumentsOf, options) =>
  main(async () => {
    const given = argumentsOf();
    await ensureInstalled();
    return runProgram(program, given, options);
  });
