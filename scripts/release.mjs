// npm run release: gives every package the next version, and moves the files of .changes into CHANGELOG.md. With
// --notes VERSION it prints that version's part of CHANGELOG.md, if every package has that version.
import { existsSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { readManifests } from './manifests.mjs';
import { mainOf, root, SetupError } from './run-command.mjs';

const bumps = ['major', 'minor', 'patch'];
const kinds = ['Added', 'Changed', 'Fixed', 'Removed', 'Security'];
const firstLine = new RegExp(`^(${bumps.join('|')}): (${kinds.join('|')})\\n+(.+)$`, 's');

/** Returns the changes since the last release, each with its bump, kind and text. */
function readChanges(directory) {
  const folder = join(directory, '.changes');
  const files = existsSync(folder) ? readdirSync(folder).filter((file) => file.endsWith('.md')) : [];
  return files.toSorted().map((file) => {
    const [, bump, kind, text] = firstLine.exec(readFileSync(join(folder, file), 'utf8').replaceAll('\r', '')) ?? [];
    if (!text)
      throw new SetupError(
        `.changes/${file}: expected a first line such as "minor: Added" (${bumps.join(', ')}: ${kinds.join(', ')}), ` +
          'then the text for CHANGELOG.md.',
      );
    return { bump, kind, text: text.trim(), path: join(folder, file) };
  });
}

/** Returns the version after this one: the first of major, minor and patch that a change asks for counts. */
export function nextVersion(version, asked) {
  const numbers = version.split('.').map(Number);
  const at = bumps.findIndex((bump) => asked.includes(bump));
  return numbers.map((number, index) => (index < at ? number : index === at ? number + 1 : 0)).join('.');
}

/** Returns a manifest, or its entry in the lock file, with this version of its own and of the project's packages. */
function atVersion(manifest, own, version) {
  const moved = { ...manifest, version };
  for (const list of ['dependencies', 'devDependencies', 'peerDependencies']) {
    for (const name of Object.keys(moved[list] ?? {})) {
      if (own.has(name)) moved[list] = { ...moved[list], [name]: version };
    }
  }
  return moved;
}

const sectionOf = (version, changes) =>
  [`## ${version}`, ...kinds.flatMap((kind) => listOf(kind, changes))].join('\n\n');

function listOf(kind, changes) {
  const texts = changes
    .filter((change) => change.kind === kind)
    .map(({ text }) => `- ${text.replaceAll('\n', '\n  ')}`);
  return texts.length === 0 ? [] : [`### ${kind}`, texts.join('\n')];
}

/** Releases the changes of a repository; returns the new version. Throws a SetupError if there are none. */
export function release(directory = root) {
  const changes = readChanges(directory);
  if (changes.length === 0) throw new SetupError('There is nothing to release: .changes has no file.');
  const manifests = readManifests(directory);
  const own = new Set(Object.values(manifests).map(({ name }) => name));
  const version = nextVersion(
    manifests['.'].version,
    changes.map(({ bump }) => bump),
  );
  const write = (path, content) => writeFileSync(join(directory, path), content);
  const writeJson = (path, value) => write(path, `${JSON.stringify(value, null, 2)}\n`);
  const lock = JSON.parse(readFileSync(join(directory, 'package-lock.json'), 'utf8'));
  for (const [folder, manifest] of Object.entries(manifests)) {
    writeJson(`${folder}/package.json`, atVersion(manifest, own, version));
    const entry = folder === '.' ? '' : folder;
    lock.packages[entry] = atVersion(lock.packages[entry], own, version);
  }
  writeJson('package-lock.json', { ...lock, version });
  const changelog = readFileSync(join(directory, 'CHANGELOG.md'), 'utf8');
  write(
    'CHANGELOG.md',
    changelog.replace(/^# .*\n+/, (title) => `${title}${sectionOf(version, changes)}\n\n`),
  );
  for (const { path } of changes) rmSync(path);
  return version;
}

/** Returns the part of CHANGELOG.md about this version. Throws a SetupError if a package has another version. */
export function releaseNotes(version, directory = root) {
  const others = Object.values(readManifests(directory)).filter((manifest) => manifest.version !== version);
  if (others.length > 0)
    throw new SetupError(
      `${others.map((each) => `${each.name} has version ${each.version}`).join(', ')}: not ${version}.`,
    );
  const sections = readFileSync(join(directory, 'CHANGELOG.md'), 'utf8').split(/^## /m);
  const section = sections.find((text) => text.split('\n')[0] === version);
  if (section === undefined) throw new SetupError(`CHANGELOG.md has no part "## ${version}".`);
  return section.slice(version.length).trim();
}

await mainOf(import.meta.url, () => {
  const { notes } = parseArgs({ options: { notes: { type: 'string' } } }).values;
  console.log(notes === undefined ? `Every package has version ${release()}.` : releaseNotes(notes));
});
