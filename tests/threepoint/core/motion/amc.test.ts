import { describe, expect, test } from 'vitest';
import { distance, vec3 } from '../../../../src/threepoint/core/math/vec3';
import { createSkeletonPose } from '../../../../src/threepoint/core/motion/imported-motion';
import { readAmc } from '../../../../src/threepoint/core/motion/read-amc';
import { readAsf } from '../../../../src/threepoint/core/motion/read-asf';
import { finishWork } from '../../../../src/threepoint/core/motion/work';

/** One bone, two long and upright at rest, whose axes are turned about Z by this angle. */
const skeleton = (unit: string, angle: number) => `:units
  length 1.0
  angle ${unit}
:root
  order TX TY TZ RX RY RZ
:bonedata
  begin
    name upper
    direction 0 1 0
    length 2
    axis 0 0 ${angle} XYZ
    dof rx
  end
:hierarchy
  begin
    root upper
  end
`;

const motion = (header: string, angle: number) => `:FULLY-SPECIFIED\n${header}\n1\nroot 0 0 0 0 0 0\nupper ${angle}\n`;

/** Returns the end of the bone in the one frame. */
function endOf(asf: string, amc: string) {
  const file = finishWork(readAmc(amc, readAsf(asf), 'person.asf'));
  const pose = createSkeletonPose(file.names.length);
  file.pose(0, pose);
  return pose.positions[file.names.indexOf('upper:end')]!;
}

/** A quarter about an axis in the picture's plane, 30 degrees above X. */
const turned = vec3(Math.sqrt(3) / 2, 0.5, Math.sqrt(3));

describe('angles of an AMC file', () => {
  test.each([
    ['degrees, as its skeleton', skeleton('deg', 30), motion(':DEGREES', 90)],
    ['radians, as its skeleton', skeleton('rad', Math.PI / 6), motion(':RADIANS', Math.PI / 2)],
    ['radians, though its skeleton has degrees', skeleton('deg', 30), motion(':RADIANS', Math.PI / 2)],
    ['degrees, though its skeleton has radians', skeleton('rad', Math.PI / 6), motion(':degrees', 90)],
    ['its skeleton’s, where it says nothing', skeleton('rad', Math.PI / 6), motion('', Math.PI / 2)],
    ['degrees, where its skeleton spells them out', skeleton('Degrees', 30), motion('', 90)],
  ])('are %s', (_, asf, amc) => {
    expect(distance(endOf(asf, amc), turned)).toBeLessThan(1e-9);
  });

  test('are refused in another unit', () => {
    expect(() => readAsf(skeleton('grad', 30))).toThrow(/^line 3, column 9: angles are in deg or rad, not in “grad”$/);
    expect(() => readAsf(skeleton('', 30))).toThrow(/^line 3, column 3: angle should have a unit, deg or rad$/);
  });
});
