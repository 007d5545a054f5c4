// node scripts/check-dependencies.mjs: checks the versions in every package.json, the lock file's hashes, the licences
// of what ships, and that docs/architecture.md gives a reason for each dependency.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { isPermissive, permissive } from './licences.mjs';
import { main, root, SetupError } from './run-command.mjs';

/** Returns the installed packages of a lock file, each with its name; links to this repository's packages are none. */
const lockedPackages = ({ packages }) =>
  Object.entries(packages).flatMap(([path, entry]) =>
    path.includes('node_modules/') && !entry.link ? [{ ...entry, name: path.split('node_modules/').at(-1) }] : [],
  );

function lockFaults(lock) {
  return lockedPackages(lock).flatMap(({ name, version, integrity, resolved, dev, license }) => [
    ...(/^sha512-/.test(integrity) ? [] : [`package-lock.json has no SHA-512 hash of ${name} ${version}`]),
    ...(resolved === undefined || resolved.startsWith('https://registry.npmjs.org/')
      ? []
      : [`package-lock.json fetches ${name} from ${resolved}, not from the registry`]),
    ...(dev || isPermissive(name, license)
      ? []
      : [`${name} ${version} ships with the licence ${license ?? '(none)'}, which is not among ${permissive}`]),
  ]);
}

const exact = /^\d+\.\d+\.\d+(-[\w.]+)?$/;

function versionFaults(manifests) {
  return Object.entries(manifests).flatMap(([folder, { dependencies, devDependencies }]) =>
    Object.entries({ ...dependencies, ...devDependencies })
      .filter(([, version]) => !exact.test(version))
      .map(([name, version]) => `${folder}/package.json asks for ${name} ${version}: name one version`),
  );
}

/** Returns the rows of the Markdown table under this heading cell, as the trimmed texts of their cells. */
function tableRows(document, heading) {
  const [, after = ''] = document.split(`| ${heading} |`);
  const [table] = after.split('\n\n');
  return table
    .split('\n')
    .filter((row) => row.startsWith('| '))
    .map((row) => row.split('|').map((cell) => cell.trim()));
}

/** Returns the folders that ship each package, by its name. Peers ship, too: the user installs them. */
function shippedBy(manifests) {
  const folders = new Map();
  const own = new Set(Object.values(manifests).map(({ name }) => name));
  for (const [folder, { dependencies, peerDependencies }] of Object.entries(manifests)) {
    for (const name of Object.keys({ ...dependencies, ...peerDependencies })) {
      if (!own.has(name)) folders.set(name, [...(folders.get(name) ?? []), folder.split('/').at(-1)]);
    }
  }
  return folders;
}

function tableFaults(manifests, document) {
  const shipped = shippedBy(manifests);
  const rows = tableRows(document, 'shipped dependency').flatMap(([, names = '', packages = '']) =>
    names.split(', ').map((name) => ({ name, packages })),
  );
  const tools = new Set(
    Object.values(manifests)
      .flatMap(({ devDependencies = {} }) => Object.keys(devDependencies))
      .filter((name) => !shipped.has(name)),
  );
  const listed = new Set(tableRows(document, 'for development').flatMap(([, names = '']) => names.split(', ')));
  const place = 'docs/architecture.md';
  return [
    ...[...shipped].flatMap(([name, folders]) => {
      const row = rows.find((each) => each.name === name);
      if (!row) return [`${place} gives no reason for ${name}, which ${folders.join(', ')} ships`];
      const same = row.packages.split(', ').toSorted().join() === folders.toSorted().join();
      return same ? [] : [`${place} has ${name} in ${row.packages}; the packages that name it: ${folders.join(', ')}`];
    }),
    ...rows.filter(({ name }) => !shipped.has(name)).map(({ name }) => `${place} has ${name}, which nothing ships`),
    ...[...tools].filter((name) => !listed.has(name)).map((name) => `${place} gives no reason for ${name}`),
    ...[...listed]
      .filter((name) => !tools.has(name))
      .map((name) => `${place} has ${name}, which no package.json names`),
  ];
}

/**
 * Returns the faults of the dependencies, one sentence each. `manifests`: every package.json by its folder.
 * @param {{ lock: object, manifests: Record<string, object>, document: string }} project
 */
const dependencyFaults = ({ lock, manifests, document }) => [
  ...versionFaults(manifests),
  ...lockFaults(lock),
  ...tableFaults(manifests, document),
];

/** Reads what `dependencyFaults` checks from the repository. */
function readProject() {
  const text = (path) => readFileSync(join(root, path), 'utf8');
  const folders = ['.', 'server', ...readdirSync(join(root, 'src')).map((name) => `src/${name}`)];
  return {
    lock: JSON.parse(text('package-lock.json')),
    manifests: Object.fromEntries(folders.map((folder) => [folder, JSON.parse(text(`${folder}/package.json`))])),
    document: text('docs/architecture.md'),
  };
}

await main(() => {
  const faults = dependencyFaults(readProject());
  if (faults.length > 0) throw new SetupError(`${faults.join('.\n')}.`);
});
