// What training/threepoint_training/train_gait.py reads: the inputs of a gait network as the page makes them, and the
// true feet, frame by frame.

import { appendFileSync, mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { reasonOf } from 'threepoint/core';
import { sides, type Vec3 } from 'threepoint/math';
import { gaitOutputCount } from '../../../src/threepoint/core/estimation/gait/gait';
import { GaitFeatures, gaitFeatureCount, yawOfHips } from '../../../src/threepoint/core/estimation/gait/gait-features';
import { loadRegressors } from '../networks';
import { peopleOf, readIndex } from '../recordings';
import { type DrivenLegs, driveLegs, type LegDriver, legDrivers } from './leg-drivers';

const width = 2 * gaitFeatureCount + gaitOutputCount;

/** Inputs, inputs of the mirrored person and the feet that truly were, of every frame of a clip. */
function framesOf(clip: DrivenLegs, driver: LegDriver, rateHz: number): Float32Array {
  const features = new GaitFeatures();
  const { eyeHeight } = clip.calibration;
  const rows = new Float32Array(clip.truth.length * width);
  clip.truth.forEach((truth, row) => {
    const hips = clip.hips[driver][row]!;
    features.update({ ...clip.points[row]!, hips }, eyeHeight, row / rateHz);
    const at = row * width;
    rows.set(features.values, at);
    rows.set(features.mirrored, at + gaitFeatureCount);
    const yaw = yawOfHips(hips.orientation);
    const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
    const level = ({ x, z }: Vec3) => [c * x - s * z, s * x + c * z] as const;
    const feet = sides.map((side) => {
      const { ankle, ball } = truth[side];
      const [x, z] = level({ x: ankle.x - hips.position.x, y: 0, z: ankle.z - hips.position.z });
      const [toesX, toesZ] = level({ x: ball.x - ankle.x, y: 0, z: ball.z - ankle.z });
      const turn = Math.atan2(-toesX, -toesZ);
      const lift = (ankle.y - clip.standingAnkle) / eyeHeight;
      return { place: [x / eyeHeight, z / eyeHeight], stands: clip.contacts[row]![side], turn, lift };
    });
    const targets = [
      ...feet.flatMap(({ place }) => place),
      ...feet.map(({ stands }) => (stands ? 1 : 0)),
      ...feet.flatMap(({ turn }) => [Math.sin(turn), Math.cos(turn)]),
      ...feet.map(({ lift }) => lift),
    ];
    rows.set(targets, at + 2 * gaitFeatureCount);
  });
  return rows;
}

async function main(): Promise<void> {
  const { recordings, models, out } = JSON.parse(process.argv[2] ?? '') as Record<
    'recordings' | 'models' | 'out',
    string
  >;
  const index = readIndex(recordings);
  const learned = (await loadRegressors(models)).get('learned') ?? null;
  mkdirSync(out, { recursive: true });
  const people: Record<string, number> = {};
  for (const person of peopleOf(index.clips)) {
    const clips = await driveLegs(recordings, index, person, learned);
    if (clips.length === 0) {
      console.log(`${person}: no legs with toes in these recordings`);
      continue;
    }
    const file = join(out, `${person}.f32`);
    writeFileSync(file, '');
    for (const clip of clips)
      for (const driver of legDrivers)
        appendFileSync(file, new Uint8Array(framesOf(clip, driver, index.rateHz).buffer));
    people[person] = legDrivers.length * clips.reduce((sum, { truth }) => sum + truth.length, 0);
  }
  const described = { people, inputs: gaitFeatureCount, outputs: gaitOutputCount, corpusHash: index.corpusHash };
  writeFileSync(join(out, 'index.json'), JSON.stringify(described));
}

await main().catch((error: unknown) => {
  console.error(reasonOf(error));
  process.exitCode = 1;
});
