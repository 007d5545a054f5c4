// Builds the packages “threepoint” and “threepoint-rooms” unless each was built from exactly these sources.
import { pathToFileURL } from 'node:url';
import { buildLibrary } from './build-library.mjs';
import { buildRooms } from './build-rooms.mjs';
import { main } from './run-command.mjs';
import { isPackageCurrent } from './source-hash.mjs';

/** The packages, and how each is built. */
export const packages = {
  threepoint: { build: buildLibrary, folder: 'dist-library' },
  'threepoint-rooms': { build: buildRooms, folder: 'dist-rooms' },
};

export async function buildPackagesWhenStale(names = Object.keys(packages)) {
  for (const { build, folder } of names.map((name) => packages[name])) if (!isPackageCurrent(folder)) await build();
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) await main(() => buildPackagesWhenStale());
