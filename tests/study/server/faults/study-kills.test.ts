// @module-tag full
import { expect, test } from 'vitest';
import { printFigures } from '../../../print-figures';
import { killedStudy } from './killed-study';

/** The number of kills; the nightly run sets a thousand (STUDY_KILLS). */
const kills = Number(process.env.STUDY_KILLS ?? 40);

test(`a study whose server is killed ${kills} times loses nothing acknowledged and mixes no conditions`, async () => {
  const report = await killedStudy(kills, 22, (line) => console.log(line));
  printFigures('a study whose server is killed', {
    kills: report.kills,
    'amid requests': report.amidRequests,
    'records acknowledged': report.acknowledged,
    'of them lost': report.lost.length,
    'participants in two conditions': report.inTwoConditions.length,
  });
  expect(report).toMatchObject({ kills, lost: [], inTwoConditions: [], undeleted: [], unsound: [] });
  expect(report.amidRequests).toBeGreaterThan(kills / 2);
}, 3_600_000);
