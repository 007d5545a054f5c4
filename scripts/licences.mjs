// The licences of the packages that a build has in it, in one file next to it.
import { existsSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { root, SetupError } from './run-command.mjs';

/** The licences that what ships may have. */
export const permissive = ['0BSD', 'Apache-2.0', 'BSD-2-Clause', 'BSD-3-Clause', 'BSL-1.0', 'ISC', 'MIT', 'Unlicense'];

/** The licences of packages whose manifests name none of SPDX, as their licence files grant them. */
const granted = { '@pmndrs/handle': 'MIT', '@pmndrs/pointer-events': 'MIT', 'xmlhttprequest-ssl': 'MIT' };

/** Whether the licence in the manifest of a package, or what its licence file grants, is permissive. */
export const isPermissive = (name, license = '') =>
  (granted[name] ?? license)
    .split(' OR ')
    .some((choice) => choice.split(' AND ').every((part) => permissive.includes(part)));

/** The list of packages that Vite's builds leave for scripts/build.mjs in the output folder. */
export const packagesFile = '.packages.json';

/** The file of the licences in a built folder. */
export const licencesFile = 'licences.txt';

/**
 * The texts of packages without a file of their licence: as their repositories have it. Files within a package that
 * have other authors are named as well.
 */
const stated = {
  'onnxruntime-web':
    'Copyright (c) Microsoft Corporation. MIT License: https://github.com/microsoft/onnxruntime/blob/main/LICENSE\n' +
    'What its WebAssembly contains: https://github.com/microsoft/onnxruntime/blob/main/ThirdPartyNotices.txt',
  three:
    'examples/jsm/libs/draco: Copyright The Draco Authors. Apache-2.0: https://www.apache.org/licenses/LICENSE-2.0\n' +
    'examples/jsm/libs/meshopt_*.js: Copyright (C) 2016-2026, by Arseny Kapoulkine. MIT',
};

/** Returns the folder of the package that a module is from; null: it is from this repository. */
const packageFolder = (module) => /^(.*[\\/]node_modules[\\/](?:@[^\\/]+[\\/])?[^\\/]+)[\\/]/.exec(module)?.[1] ?? null;

/**
 * Returns a plug-in that collects in `folders` the packages that the chunks of a build are from. In Vite it is for the
 * pages and for their workers.
 */
export const packageCollector = (folders) => ({
  name: 'package-collector',
  generateBundle(_, bundle) {
    for (const { moduleIds = [] } of Object.values(bundle)) {
      for (const folder of moduleIds.map(packageFolder)) if (folder !== null) folders.add(folder);
    }
  },
});

/** Returns the folders of these packages and of all that they depend on, as Node finds them from `from`. */
export function installedFolders(names, from = root, found = new Set()) {
  for (const name of names) {
    let parent = from;
    while (!existsSync(join(parent, 'node_modules', name)) && parent !== dirname(parent)) parent = dirname(parent);
    const folder = join(parent, 'node_modules', name);
    if (found.has(folder)) continue;
    found.add(folder);
    const { dependencies = {} } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
    installedFolders(Object.keys(dependencies), folder, found);
  }
  return found;
}

/** Returns the name, the version, the licence and its texts of the package in a folder. */
function entryOf(folder) {
  const { name, version, license } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  if (!isPermissive(name, license)) {
    throw new SetupError(
      `${name} ${version} has the licence ${license ?? '(none)'}, which nothing that ships may have.`,
    );
  }
  const files = readdirSync(folder).filter((file) => /^(licen[cs]e|copying|notice)/i.test(file));
  const texts = [...files.toSorted().map((file) => readFileSync(join(folder, file), 'utf8')), stated[name] ?? ''];
  const text = texts
    .map((each) => each.trim())
    .filter(Boolean)
    .join('\n\n');
  if (text === '')
    throw new SetupError(`${name} ${version} has no file of its licence: scripts/licences.mjs states it.`);
  return `${name} ${version} (${granted[name] ?? license})\n\n${text}\n`;
}

/**
 * Writes the licences of the packages in these folders into a built folder. Throws a SetupError if a package has a
 * licence that nothing that ships may have, or no text of it.
 */
export function writeLicences(out, folders) {
  const entries = [...new Set([...folders].map(entryOf))].toSorted();
  const heading = 'This build contains these packages, each under the licence that follows its name.\n';
  writeFileSync(join(out, licencesFile), [heading, ...entries].join(`\n${'-'.repeat(79)}\n\n`));
}
