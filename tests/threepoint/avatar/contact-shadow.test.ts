import { vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { ContactShadow } from '../../../src/threepoint/avatar/contact-shadow';

/** The discs that are visible: the middle [m], and how dark it is there. */
function discsOf({ object: { geometry } }: ContactShadow) {
  const position = geometry.getAttribute('position');
  const color = geometry.getAttribute('color');
  return [0, 4, 8].flatMap((first) => {
    const darkness = color.getW(first);
    const middle = (of: (vertex: number) => number) => (of(first) + of(first + 2)) / 2;
    const at = [middle((i) => position.getX(i)), middle((i) => position.getZ(i))];
    return darkness > 0 ? [{ at: at.map((value) => Number(value.toFixed(4))), darkness }] : [];
  });
}

const hips = vec3(0.1, 0.95, -0.2);
const leftFoot = vec3(0, 0.09, -0.3);

test('a shadow lies under body and feet, and fades under a foot that is lifted', () => {
  const shadow = new ContactShadow();
  const [body, left, right] = [0, 1, 2];
  shadow.follow({ hips, leftFoot, rightFoot: vec3(0.2, 0.09, -0.3) });
  const standing = discsOf(shadow);
  expect(standing.map(({ at }) => at)).toEqual([
    [0.1, -0.2],
    [0, -0.3],
    [0.2, -0.3],
  ]);
  shadow.follow({ hips, leftFoot, rightFoot: vec3(0.2, 0.25, -0.3) });
  const stepping = discsOf(shadow);
  expect(stepping[left!]).toEqual(standing[left!]);
  expect(stepping[body!]).toEqual(standing[body!]);
  expect(stepping[right!]!.darkness).toBeLessThan(0.6 * standing[right!]!.darkness);
  shadow.follow({ hips, leftFoot, rightFoot: vec3(0.2, 0.6, -0.3) });
  expect(discsOf(shadow)).toHaveLength(2);
});

test('a shadow lies aside where the body is drawn, and nowhere without a body', () => {
  const shadow = new ContactShadow();
  shadow.follow({ hips, leftFoot }, 1.2);
  expect(discsOf(shadow).map(({ at }) => at)).toEqual([
    [1.3, -0.2],
    [1.2, -0.3],
  ]);
  shadow.follow({});
  expect(discsOf(shadow)).toEqual([]);
});
