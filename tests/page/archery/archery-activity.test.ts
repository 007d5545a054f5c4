import { defaultCalibration, nothingPressed } from 'threepoint/core';
import { normalise, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { createArcheryActivity } from '../../../src/page/archery/archery-activity';
import { settlingSeconds } from '../../../src/page/scene/boards/sheet';
import { posed } from '../../games/archery/bowman';
import { activityServices } from '../activity-services';
import { drawNowhere } from '../shell/drawing-in-node';

drawNowhere();

test('the button of a result takes a press a moment after the sheet appears', () => {
  const { services, writer } = activityServices();
  writer.change({ startSignal: true, seconds: 1 });
  const archery = createArcheryActivity({
    ...services,
    layout: { seed: 7 },
    place: null,
    inputSource: 'headset',
    chooseInput: () => undefined,
    setSound: () => undefined,
    reopen: () => undefined,
    placeCamera: () => undefined,
  });
  const eyes = vec3(0, defaultCalibration.eyeHeight, 0);
  // Straight ahead the button lies 0.36 m below the middle of the sheet, that 0.18 m below the eyes.
  const ray = { origin: eyes, direction: normalise(vec3(0, -0.54, -2.1)) };
  let time = 20;
  const pass = (seconds: number) => {
    for (let i = 0; i < Math.round(72 * seconds); i++) {
      time += 1 / 72;
      const frame = posed(time);
      archery.update(frame, nothingPressed);
      archery.show(time, frame);
    }
  };
  archery.play.signal();
  pass(0.9);
  expect(archery.point(ray, false)).toBeNull();
  pass(0.2);
  expect(archery.round()?.over).toBe(true);
  expect(archery.point(ray, false), 'a press that was meant for the bow').toBeNull();
  pass(settlingSeconds);
  expect(archery.point(ray, false)?.distance).toBeCloseTo(Math.hypot(0.54, 2.1), 1);
});
