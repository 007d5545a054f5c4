import { createHash } from 'node:crypto';
import { existsSync, readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join, relative } from 'node:path';
import { pathToFileURL } from 'node:url';
import { promisify } from 'node:util';
import { brotliCompress, constants, gzip } from 'node:zlib';
import { main, root, run, SetupError } from './run-command.mjs';

/** Everything the built page depends on. */
const sources = [
  'index.html',
  'results.html',
  'experimenter.html',
  'vite.config.ts',
  'tsconfig.json',
  'package-lock.json',
  'public',
  'src',
  'scripts/build.mjs',
];
const stampFile = join(root, 'dist/.source-hash');

/** Text and machine code shrink; pictures and quantised weights do not. */
const compressible = /\.(html|js|css|json|svg|wasm|txt|vrm|glb|webmanifest)$/;

function filesUnder(path) {
  if (!existsSync(path)) return [];
  if (!statSync(path).isDirectory()) return [path];
  return readdirSync(path)
    .sort()
    .flatMap((name) => filesUnder(join(path, name)));
}

function sourceHash() {
  const hash = createHash('sha256');
  for (const file of sources.flatMap((source) => filesUnder(join(root, source)))) {
    hash
      .update(`${relative(root, file)}\0`)
      .update(readFileSync(file))
      .update('\0');
  }
  return hash.digest('hex');
}

/** Puts .br and .gz beside the files that get smaller by it, so that the server never compresses while it serves. */
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

/** Builds dist/ from the sources, whether or not it is stale. */
export async function build() {
  const hash = sourceHash();
  const { code } = await run(process.execPath, ['node_modules/vite/bin/vite.js', 'build', '--logLevel', 'warn']);
  if (code !== 0) throw new SetupError(`The build failed with exit code ${code}; its messages are above.`);
  await precompress(join(root, 'dist'));
  writeFileSync(stampFile, hash);
}

/** Builds dist/ when it was not built from exactly these sources. */
export async function buildWhenStale() {
  if (existsSync(stampFile) && readFileSync(stampFile, 'utf8') === sourceHash()) return;
  const start = performance.now();
  console.log('Building the page ...');
  await build();
  console.log(`Built in ${((performance.now() - start) / 1000).toFixed(1)} s.`);
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) await main(build);
