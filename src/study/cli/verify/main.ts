import { existsSync, readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { fileURLToPath } from 'node:url';
import { reasonOf } from 'threepoint/core';
import { readSoftwareVersion } from 'threepoint-http';
import { verifyExport } from './verify-export';

const [path = ''] = process.argv.slice(2);
const file = basename(path);
/** The most complaints that are printed, because more of them have one cause. */
const maxShown = 50;

try {
  if (!existsSync(path)) throw new Error('there is no such file');
  const here = readSoftwareVersion(
    fileURLToPath(new URL('../../../../public', import.meta.url)),
    new URL('../../../../package.json', import.meta.url),
  );
  const { problems, files, records, exportedBy } = verifyExport(readFileSync(path));
  if (exportedBy.version !== here.version) {
    console.log(
      `${file} was exported by version ${exportedBy.version}; this is ${here.version}, which may write other columns.`,
    );
  }
  for (const problem of problems.slice(0, maxShown)) console.log(`${file}: ${problem}`);
  if (problems.length > maxShown) console.log(`… and ${problems.length - maxShown} more.`);
  const what = `${files} files, recomputed from ${records} records`;
  console.log(problems.length === 0 ? `${file}: sound: ${what}.` : `${file}: ${problems.length} faults; ${what}.`);
  process.exitCode = problems.length === 0 ? 0 : 1;
} catch (error) {
  console.error(`${file}: ${reasonOf(error)}`);
  process.exitCode = 1;
}
