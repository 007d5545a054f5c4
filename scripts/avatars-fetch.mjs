// npm run tool -- avatars:fetch DIR: downloads the public avatars and motions of tools/avatars/try/public-files.json
// from GitHub, each at a fixed commit, for `npm run tool -- avatars:try DIR`. Files that are there already are kept.
// The files belong to their authors: they are not part of this repository.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { readOptions } from './command-line.mjs';
import { main, root } from './run-command.mjs';

const usage = 'npm run tool -- avatars:fetch DIR';
const limitMs = 120_000;

/** Returns the address of a file at a commit. Large files are kept in another store, of which GitHub has a pointer. */
const addressOf = ({ repository, commit, path }, host = 'https://raw.githubusercontent.com') =>
  `${host}/${repository}/${commit}/${path.split('/').map(encodeURIComponent).join('/')}`;
const mediaHost = 'https://media.githubusercontent.com/media';

async function download(address) {
  const response = await fetch(address, { signal: AbortSignal.timeout(limitMs) });
  if (!response.ok) throw new Error(`the server answers ${response.status} ${response.statusText}`.trim());
  return Buffer.from(await response.arrayBuffer());
}

async function fetchFile(file) {
  const bytes = await download(addressOf(file));
  return bytes.subarray(0, 8).toString('latin1') === 'version ' ? download(addressOf(file, mediaHost)) : bytes;
}

await main(async () => {
  const { rest } = readOptions('avatars:fetch', usage, { rest: 'paths' }, ({ rest }) => {
    if (rest.length !== 1) throw new Error('a folder is needed');
  });
  const [folder] = rest;
  mkdirSync(folder, { recursive: true });
  const files = JSON.parse(readFileSync(join(root, 'tools/avatars/try/public-files.json'), 'utf8'));
  let missing = 0;
  for (const file of files) {
    const target = join(folder, file.name);
    if (existsSync(target)) continue;
    try {
      writeFileSync(target, await fetchFile(file));
      console.log(`+ ${file.name}`);
    } catch (error) {
      missing += 1;
      console.log(`- ${file.name}: ${error.message} (${addressOf(file)})`);
    }
  }
  console.log(`${files.length - missing} of ${files.length} files in ${folder}`);
  return missing > 0 ? 1 : 0;
});
