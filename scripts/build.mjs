import { existsSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { parseArgs, promisify } from 'node:util';
import { brotliCompress, constants, gzip } from 'node:zlib';
import { buildServiceWorker } from './build-service-worker.mjs';
import { packagesFile, writeLicences } from './licences.mjs';
import { mainOf, root, run, SetupError } from './run-command.mjs';
import { filesUnder, isStamped, sourceHash } from './source-hash.mjs';

/** The paths that the built page depends on. */
const sources = [
  'index.html',
  'check.html',
  'embed.html',
  'results.html',
  'experimenter.html',
  'withdraw.html',
  '404.html',
  'vite.config.ts',
  'tsconfig.json',
  'package-lock.json',
  'public',
  'src',
  'scripts/build.mjs',
  'scripts/build-service-worker.mjs',
  'scripts/licences.mjs',
];

const stampFile = '.source-hash';

/**
 * The defaults of the build: the base path (relative, so that any folder works), the output folder, and the origins
 * from which the page may load files (null: the host's header decides).
 */
const usual = { base: './', out: join(root, 'dist'), filesFrom: null };

/** The files that are worth compressing: text and machine code, not pictures and quantised weights. */
const compressible = /\.(html|js|css|json|svg|wasm|txt|vrm|glb|webmanifest)$/;

/** Returns the options of `npm run build -- …`. Throws a SetupError if they are invalid. */
export function buildOptions(args) {
  let values;
  try {
    ({ values } = parseArgs({
      args,
      options: { base: { type: 'string' }, out: { type: 'string' }, 'files-from': { type: 'string' } },
    }));
  } catch (error) {
    throw new SetupError(
      `${error.message} npm run build takes --base (a folder such as /threepoint/), --out (a directory) and --files-from (origins, with commas between).`,
    );
  }
  const { base = usual.base, out, 'files-from': filesFrom = usual.filesFrom } = values;
  const strange = filesFrom?.split(',').find((origin) => origin && !/^https:\/\/[\w.-]+(:\d+)?$/.test(origin));
  if (strange)
    throw new SetupError(`--files-from ${strange}: expected origins such as https://example.org, or "" for none.`);
  if (!/^(\.\/|\/([\w~-][\w.~-]*\/)*)$/.test(base)) {
    throw new SetupError(
      `--base ${base || '""'}: expected the path of a folder with a slash at either end, such as /threepoint/, or ./ for a page that runs from any folder.`,
    );
  }
  return { base, out: out === undefined ? usual.out : emptied(out), filesFrom };
}

/**
 * Returns the full path of a directory that is missing, empty, or an earlier build. Throws if it holds anything else.
 */
function emptied(out) {
  if (out === '') throw new SetupError('--out "": expected a directory for the built page.');
  const directory = resolve(root, out);
  if (existsSync(directory) && readdirSync(directory).length > 0 && !existsSync(join(directory, stampFile))) {
    throw new SetupError(`--out ${out}: there are files in it that no build has put there; a build would delete them.`);
  }
  return directory;
}

const hashOf = ({ base, filesFrom }) => sourceHash(sources, `${base}\0${filesFrom}\0`);

/** Writes .br and .gz next to the files that get smaller by it, so that the server never compresses on request. */
async function precompress(directory) {
  const files = filesUnder(directory).filter((file) => compressible.test(file) && statSync(file).size > 1024);
  await Promise.all(
    files.map(async (file) => {
      const content = readFileSync(file);
      const brotliOptions = { params: { [constants.BROTLI_PARAM_QUALITY]: 9, [constants.BROTLI_PARAM_LGWIN]: 22 } };
      const [br, gz] = await Promise.all([
        promisify(brotliCompress)(content, brotliOptions),
        promisify(gzip)(content, { level: 7 }),
      ]);
      if (br.length < content.length * 0.9) writeFileSync(`${file}.br`, br);
      if (gz.length < content.length * 0.9) writeFileSync(`${file}.gz`, gz);
    }),
  );
}

/**
 * Builds the page from the sources, even if it is up to date.
 * @param {{ base: string, out: string, filesFrom?: string | null }} options
 */
export async function build({ base, out, filesFrom = usual.filesFrom } = usual) {
  const hash = hashOf({ base, filesFrom });
  const vite = ['node_modules/vite/bin/vite.js', 'build', '--logLevel', 'warn'];
  const buildPages = async (pages) => {
    const { code } = await run(process.execPath, [...vite, '--base', base, '--outDir', out], {
      env: {
        THREEPOINT_BUILD_PAGES: pages,
        ...(filesFrom !== null && { THREEPOINT_BUILD_FILES_FROM: filesFrom }),
      },
    });
    if (code !== 0) throw new SetupError(`The build failed with exit code ${code}; its messages are above.`);
  };
  await buildPages('all');
  const inServiceWorker = await buildServiceWorker(out);
  // After the service worker, whose list is what the other pages load.
  await buildPages('apart');
  const list = join(out, packagesFile);
  writeLicences(out, [...inServiceWorker, ...JSON.parse(readFileSync(list, 'utf8'))]);
  rmSync(list);
  await precompress(out);
  writeFileSync(join(out, stampFile), hash);
}

/** Builds dist/ unless it was built from exactly these sources. */
export async function buildWhenStale() {
  if (isStamped(join(usual.out, stampFile), hashOf(usual))) return;
  const start = performance.now();
  console.log('Building the page ...');
  await build();
  console.log(`Built in ${((performance.now() - start) / 1000).toFixed(1)} s.`);
}

await mainOf(import.meta.url, () => build(buildOptions(process.argv.slice(2))));
