// npm run check:headset -- FILE …: validates the files of headset checks and prints their figures.
import { ValidationError } from 'threepoint/core';
import { reportSections } from '../../src/page/check/report-sections';
import { readCheckFile } from './checked-headset';

for (const file of process.argv.slice(2)) {
  try {
    const report = readCheckFile(file);
    console.log(`${file}: valid`);
    for (const { title, lines } of reportSections(report)) {
      console.log(`  ${title}`);
      for (const { label, value } of lines) console.log(`    ${label.padEnd(36)} ${value}`);
    }
  } catch (error) {
    if (!(error instanceof ValidationError)) throw error;
    console.error(`check:headset: ${error.message}`);
    process.exitCode = 1;
  }
}
