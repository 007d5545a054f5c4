import { expect, test } from 'vitest';
import { distance } from '../../../../src/threepoint/core/math/vec3';
import { writeCsv } from '../../../../src/threepoint/core/motion/write-csv';
import { actingPerson, contortedPerson, textOf } from './moved-person';

const people = { contorted: contortedPerson(), acting: actingPerson(1) };

test.each(Object.entries(people))(
  'the table of the %s person has every joint within 1 mm, floor frame',
  (_, { motion, truth }) => {
    const [header, ...rows] = textOf(writeCsv(motion)).trimEnd().split('\n');
    const columns = header!.split(',');
    expect(rows.length).toBe(truth.length);
    const joints = columns.filter((name) => name.endsWith('_x')).map((name) => name.slice(0, -2));
    expect(joints.length).toBe(14 + 30);
    for (const [frame, row] of rows.entries()) {
      const numbers = row.split(',').map(Number);
      expect(numbers[0]).toBeCloseTo(motion.times[frame]!, 6);
      expect(numbers.slice(1, 3)).toEqual([motion.seen[frame]! & 1, motion.seen[frame]! >> 1]);
      for (const name of joints) {
        const at = columns.indexOf(`${name}_x`);
        const [x, y, z] = numbers.slice(at, at + 3) as [number, number, number];
        expect(distance({ x, y, z }, truth[frame]!.get(name)!.position), name).toBeLessThan(1e-3);
      }
    }
  },
);

test('legs, which are not measured, have no columns', () => {
  const [header] = textOf(writeCsv(people.acting.motion)).split('\n');
  expect(header).not.toMatch(/Leg|Foot/);
});
