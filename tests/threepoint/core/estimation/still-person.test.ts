import fc from 'fast-check';
import { describe } from 'vitest';
import { isNightly } from '../../../nightly';
import { factIf, fitted, jointsOf, openSubject } from './contract-subjects';
import { type Joints, show } from './drawn';
import {
  expectSlow,
  expectStill,
  maxHandErrorOfPaper,
  rate,
  settled,
  slowPerson,
  stillPerson,
  watched,
} from './still-people';

describe.each(fitted)('$label draws a person', (subject) => {
  const { create, runs } = openSubject(subject);

  factIf(true)('who holds still: after two seconds still, hands within reach on their controllers', async () => {
    await fc.assert(
      fc.asyncProperty(stillPerson, async (person) => {
        const { calibration, frame } = person;
        const estimator = create(calibration);
        for (let i = 0; i < settled; i++) await show(estimator, frame(i * rate));
        const drawn: Joints[] = [];
        for (let i = settled; i < settled + watched; i++)
          drawn.push(jointsOf(await show(estimator, frame(i * rate)), calibration));
        expectStill(drawn, person, subject.name === 'paper' && isNightly ? maxHandErrorOfPaper : undefined);
      }),
      runs(40),
    );
  });

  factIf(true)('whose hands move slowly: no joint goes much further in a frame than they do', async () => {
    await fc.assert(
      fc.asyncProperty(slowPerson, async ({ calibration, count, frame }) => {
        const estimator = create(calibration);
        for (let i = -settled; i < 0; i++) await show(estimator, frame(i));
        const drawn: Joints[] = [];
        for (let i = 0; i <= count; i++) drawn.push(jointsOf(await show(estimator, frame(i)), calibration));
        expectSlow(drawn);
      }),
      runs(20),
    );
  });
});
