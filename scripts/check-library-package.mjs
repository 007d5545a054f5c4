// Checks what the built packages promise: the links of their documents, the fields of their manifests, and by publint
// and attw how Node, bundlers and the compiler resolve them. Checks dist-library's source maps and declaration maps,
// the paths that its licence names, and the sizes of what pages import from it.
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join, relative } from 'node:path';
import { packages } from './build-packages.mjs';
import { wrongSizes } from './library-sizes.mjs';
import { main, root, run, SetupError } from './run-command.mjs';

const folder = join(root, 'dist-library');
const folders = Object.values(packages).map(({ folder }) => join(root, folder));

const filesOf = (folder) => readdirSync(folder, { recursive: true }).map((file) => join(folder, file));
const files = filesOf(folder);
const endingWith = (ending) => files.filter((file) => file.endsWith(ending));
const named = (file) => relative(folder, file);
const linksOf = (text) => [...text.matchAll(/\]\(([^)\s]+)\)/g)].map(([, target]) => target);

/** Returns the anchors of a Markdown document's headings. */
const anchorsOf = (text) =>
  [...text.matchAll(/^#+ (.*)$/gm)].map(([, heading]) =>
    heading
      .toLowerCase()
      .replace(/[^\p{L}\p{N}\s_-]/gu, '')
      .trim()
      .replaceAll(' ', '-'),
  );

function deadLinks(folder) {
  const documents = filesOf(folder).filter((file) => file.endsWith('.md'));
  return documents.flatMap((file) =>
    linksOf(readFileSync(file, 'utf8')).flatMap((link) => {
      if (/^[a-z]+:/.test(link)) return [];
      const [path, anchor] = link.split('#');
      const target = path === '' ? file : join(dirname(file), path);
      if (!existsSync(target)) return [`${relative(root, file)} links to ${link}, which is not in the package`];
      if (anchor === undefined || anchorsOf(readFileSync(target, 'utf8')).includes(anchor)) return [];
      return [`${relative(root, file)} links to ${link}, which is no heading`];
    }),
  );
}

function faultyMaps() {
  return endingWith('.map').flatMap((file) => {
    const { sources, sourcesContent = [] } = JSON.parse(readFileSync(file, 'utf8'));
    // Editors follow declaration maps to files; debuggers show the content that source maps bring along.
    const missing = sources.filter((source, i) =>
      file.endsWith('.d.ts.map') ? !existsSync(join(dirname(file), source)) : typeof sourcesContent[i] !== 'string',
    );
    return missing.map((source) => `${named(file)} has no source for ${source}`);
  });
}

/** Whether a file has code besides imports and exports, for which bundlers write a map. */
const hasCode = (file) =>
  readFileSync(file, 'utf8')
    .replace(/^(import|export) .*$/gm, '')
    .trim() !== '';

/** Whether a file needs no map: embedded files, the bundler's own functions, and bundles of modules of the package. */
const needsNoMap = (name) =>
  ['learned-weights.js', 'mannequin.js', 'validator.js', 'bundled/runtime.js'].includes(name) ||
  name.startsWith('bundled/gltf-validator') ||
  name.startsWith('min/');

/** Returns a message for each declaration and each file of code that lacks its map. */
function missingMaps() {
  const code = [...endingWith('.js').filter(hasCode), ...endingWith('.d.ts')];
  return code
    .filter((file) => !existsSync(`${file}.map`) && !needsNoMap(named(file)))
    .map((file) => `${named(file)} has no map`);
}

function licencePaths() {
  const text = readFileSync(join(folder, 'LICENSE'), 'utf8');
  const paths = [...text.matchAll(/\b[\w-]+\/(?:[\w-]+\/)*(?:[\w-]+\.\w+|(?=\s))/g)].map(([path]) => path);
  return paths
    .filter((path) => !existsSync(join(folder, path)))
    .map((path) => `LICENSE names ${path}, which is not there`);
}

/** Returns a message for each package of a bundled module, by the sources of the maps, that licences.txt lacks. */
function missingLicences(folder) {
  const licences = join(folder, 'licences.txt');
  const named = existsSync(licences) ? readFileSync(licences, 'utf8') : '';
  const maps = filesOf(folder).filter((file) => file.endsWith('.js.map'));
  const sources = maps.flatMap((file) => JSON.parse(readFileSync(file, 'utf8')).sources);
  const bundled = new Set(sources.flatMap((source) => /.*node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(source)?.[1] ?? []));
  return [...bundled]
    .filter((name) => !named.includes(`\n${name} `))
    .map((name) => `${relative(root, folder)}/licences.txt lacks ${name}`);
}

function missingFields(folder) {
  const manifest = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const needed = ['name', 'version', 'description', 'license', 'engines', 'sideEffects', 'exports', 'peerDependencies'];
  return needed
    .filter((field) => manifest[field] === undefined)
    .map((field) => `${relative(root, folder)}/package.json has no ${field}`);
}

/** Returns a message for each package that Node, bundlers or the compiler resolve wrongly. */
async function wronglyResolved() {
  const faults = [];
  for (const folder of folders) {
    // Without npx, which takes half a second to find each.
    const checks = {
      publint: ['node_modules/publint/src/cli.js', folder, '--strict'],
      attw: ['node_modules/@arethetypeswrong/cli/dist/index.js', '--pack', folder, '--profile', 'esm-only', '--quiet'],
    };
    for (const [name, check] of Object.entries(checks))
      if ((await run(process.execPath, check)).code !== 0)
        faults.push(`${name} has faults in ${relative(root, folder)}`);
  }
  return faults;
}

await main(async () => {
  const faults = [
    ...folders.flatMap((folder) => [...deadLinks(folder), ...missingFields(folder), ...missingLicences(folder)]),
    ...faultyMaps(),
    ...missingMaps(),
    ...licencePaths(),
    ...(await wrongSizes()),
    ...(await wronglyResolved()),
  ];
  if (faults.length > 0) throw new SetupError(`A package is not as it promises:\n${faults.join('\n')}`);
});
