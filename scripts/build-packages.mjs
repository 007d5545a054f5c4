// Builds the packages “threepoint” and “threepoint-rooms” unless each was built from exactly these sources.
import { buildLibrary } from './build-library.mjs';
import { buildRooms } from './build-rooms.mjs';
import { mainOf } from './run-command.mjs';
import { isPackageCurrent } from './source-hash.mjs';

/** The packages, and how each is built. */
export const packages = {
  threepoint: { build: buildLibrary, folder: 'dist-library' },
  'threepoint-rooms': { build: buildRooms, folder: 'dist-rooms' },
};

export async function buildPackagesWhenStale(names = Object.keys(packages)) {
  for (const { build, folder } of names.map((name) => packages[name])) if (!isPackageCurrent(folder)) await build();
}

await mainOf(import.meta.url, () => buildPackagesWhenStale());
