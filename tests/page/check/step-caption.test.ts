import { Vector3 } from 'three';
import { fromAxisAngle, type Pose, up, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { StepCaption } from '../../../src/page/check/step-caption';
import { wallDistance } from '../../../src/page/studio/mirrors';
import { drawNowhere } from '../shell/drawing-in-node';

drawNowhere();

const eyes = vec3(0, 1.6, 0);
const looking = (degrees: number): Pose<'floor'> => ({
  position: eyes,
  orientation: fromAxisAngle(up, (degrees * Math.PI) / 180),
});

/** Returns the directions of the caption's left and right edge, to the right of −Z [degrees]. */
function edges({ object }: StepCaption): readonly number[] {
  object.updateMatrixWorld();
  return [-0.45, 0.45].map((x) => {
    const at = object.localToWorld(new Vector3(x, 0, 0));
    return (Math.atan2(at.x - eyes.x, -(at.z - eyes.z)) * 180) / Math.PI;
  });
}

test('the caption of a step leaves the reflection of the body free', () => {
  const caption = new StepCaption();
  caption.show(0, looking(0));
  // The reflection of shoulders 0.5 m wide, as far behind the glass as the user is before it.
  const shoulder = (Math.atan2(0.25, 2 * wallDistance) * 180) / Math.PI;
  for (const edge of edges(caption)) expect(edge).toBeGreaterThan(shoulder);
});

test('a head that turns to the caption finds it ahead, and takes it along', () => {
  const caption = new StepCaption();
  let time = 0;
  const turnTo = (degrees: number) => {
    for (let i = 0; i < 40; i++) {
      time += 0.1;
      caption.show(time, looking(degrees));
    }
    const [left, right] = edges(caption);
    return (left! + right!) / 2 + degrees;
  };
  expect(turnTo(0)).toBeCloseTo(28.6, 0);
  expect(turnTo(-28)).toBeCloseTo(0.6, 0);
  expect(turnTo(-90)).toBeCloseTo(0, 0);
  expect(turnTo(0)).toBeCloseTo(28.6, 0);
});
