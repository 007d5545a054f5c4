import { expect, test } from 'vitest';
import { Phrases } from '../../../src/study/model/phrases/phrases';
import type { StudyScreen } from '../../../src/study/participant/questions/study-screen';
import { VrStudyPanel } from '../../../src/study/participant/sheet/vr-study-panel';
import { drawNowhere } from '../../page/shell/drawing-in-node';

drawNowhere();

const screen: StudyScreen = {
  ...{ id: 'setup', kicker: 'Archery', title: 'Not quite ready', text: ['Stand up.'], footnote: '', trouble: true },
  ...{ phrases: new Phrases('en'), hint: null, figure: null, part: null, question: null },
  buttons: [{ id: 'calibrate', label: 'Measure again', look: 'primary', act: () => undefined }],
};

const ahead = { x: 0, z: -1 };
const eyesAt = (y: number, x = 0) => ({ position: { x, y, z: 0 }, forward: ahead });

/** A sheet before a person whose eyes are at this height [m]. */
function sheetBefore(eyes: number) {
  const sheet = new VrStudyPanel();
  sheet.show(screen);
  sheet.follow(eyesAt(eyes));
  return sheet;
}

test('the sheet stands a little below the eyes and comes down with a sitting person', () => {
  const sheet = sheetBefore(1.7);
  expect(sheet.object.position.y).toBeCloseTo(1.58, 9);
  sheet.follow(eyesAt(0.9));
  expect(sheet.object.position.y).toBeCloseTo(0.78, 9);
  sheet.follow(eyesAt(1.7));
  expect(sheet.object.position.y).toBeCloseTo(1.58, 9);
});

test('the sheet stays where it is before a person who nods, bends a knee or sways', () => {
  const sheet = sheetBefore(1.7);
  for (const [eyes, aside] of [
    [1.6, 0],
    [1.45, 0.2],
    [1.75, -0.3],
  ] as const) {
    sheet.follow(eyesAt(eyes, aside));
    expect(sheet.object.position.toArray()).toEqual([0, expect.closeTo(1.58, 9), -1.25]);
  }
});

test('the sheet comes round to a person who turns', () => {
  const sheet = sheetBefore(1.7);
  sheet.follow({ position: { x: 0, y: 1.7, z: 0 }, forward: { x: 1, z: 0 } });
  expect(sheet.object.position.x).toBeCloseTo(1.25, 9);
  expect(sheet.object.position.z).toBeCloseTo(0, 9);
});
