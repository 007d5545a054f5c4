import { expect, test } from 'vitest';
import { prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { trackedWidth } from '../../../../src/threepoint/core/mocap/simulate-trackers';
import { truthJoints } from '../../../../src/threepoint/core/mocap/skeleton-map';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { goldenMocap, sourceOf } from './golden-mocap';

test.each(goldenMocap)('$motion becomes the recordings that the evaluation makes of it', (golden) => {
  const { clips } = finishWork(prepareMocap(sourceOf(golden)));
  expect(clips.map(({ name, frameCount }) => [name, frameCount])).toEqual(
    golden.clips.map(({ name, frames }) => [name, frames]),
  );
  for (const [i, { calibration, rows }] of golden.clips.entries()) {
    const clip = clips[i]!;
    expect(clip.calibration.eyeHeight).toBeCloseTo(calibration.eyeHeight, 8);
    expect(clip.calibration.armSpan).toBeCloseTo(calibration.armSpan, 8);
    expect(golden.columns.slice(trackedWidth).map((name) => name.split('.')[1])).toEqual(
      truthJoints.flatMap((joint) => [joint, joint, joint]),
    );
    for (const [row, numbers] of rows.entries()) {
      const frame = row * golden.stride;
      const tracked = clip.tracked.subarray(frame * trackedWidth, (frame + 1) * trackedWidth);
      const truth = clip.truth.subarray(frame * 3 * truthJoints.length, (frame + 1) * 3 * truthJoints.length);
      for (const point of [0, 7, 14]) {
        // A quaternion and its negative are one rotation.
        const same = [3, 4, 5, 6].reduce((sum, k) => sum + tracked[point + k]! * numbers[point + k]!, 0);
        if (same < 0) for (const k of [3, 4, 5, 6]) tracked[point + k]! *= -1;
      }
      for (const [k, number] of [...tracked, ...truth].entries())
        expect(Math.abs(number - numbers[k]!), `${golden.columns[k]}, frame ${frame}`).toBeLessThan(1e-5);
    }
  }
});
