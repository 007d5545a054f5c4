import { InstancedMesh, Matrix4, Vector3 } from 'three';
import { GazeTargets } from 'threepoint/internal/three';
import { distance, fromAxisAngle, isFiniteVec3, up, vec3 } from 'threepoint/math';
import { fallTime } from 'threepoint-games';
import { ballInAir, ballRadius, ballRules, defaultBallOptions } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { Balls } from '../../../src/page/ball/view/balls';
import { velocityTo } from '../../rooms/client/people';

/** The look of each ball that is drawn, and the side of the court it lies on: −1 left, 1 right. */
function drawn(count: number): { readonly look: number; readonly side: number }[] {
  const view = new Balls(defaultBallOptions.balls, 'low');
  view.show(ballRules.start(['a', 'b', 'c'], 1, { balls: count }), 0, () => null, null);
  const meshes = view.object.children.filter((child) => child instanceof InstancedMesh).slice(0, 2);
  const matrix = new Matrix4();
  const at = new Vector3();
  const balls: { look: number; side: number }[] = [];
  for (const [look, mesh] of meshes.entries()) {
    for (let i = 0; i < mesh.count; i++) {
      mesh.getMatrixAt(i, matrix);
      if (matrix.determinant() > 0) balls.push({ look, side: Math.sign(at.setFromMatrixPosition(matrix).x) });
    }
  }
  return balls;
}

test.each([1, 4, 7, 10, 20])(
  'the left rack’s share of %d balls looks like the first, the right’s like the second',
  (count) => {
    const balls = drawn(count);
    expect(balls).toHaveLength(count);
    for (const { look, side } of balls) expect(look).toBe(side < 0 ? 0 : 1);
  },
);

test('balls in the air and in hands attract eyes, and those in a rack do not', () => {
  const fresh = ballRules.start(['a', 'b', 'c'], 1);
  const launch = { time: 1, position: vec3(0, 1.5, -0.5), velocity: vec3(0, 3, -2) };
  const balls = fresh.balls.map((place, ball) => {
    if (ball === 0) return { on: 'air', launch, thrower: 0, missed: false } as const;
    return ball === 1 ? ({ on: 'hand', player: 2, side: 'left' } as const) : place;
  });
  const palm = vec3(1, 1.2, -2);
  const view = new Balls(20, 'low');
  view.show({ ...fresh, balls }, 1.25, () => palm, null);
  const targets = new GazeTargets();
  view.addGazeTargets(targets, { position: vec3(0.5, 0, -1), orientation: fromAxisAngle(up, Math.PI) });
  const places = Array.from({ length: targets.count }, (_, i) => targets.at(i).position);
  const seen = places.filter(isFiniteVec3);
  expect(seen).toHaveLength(2);
  const flying = ballInAir(launch, 1.25);
  expect(distance(seen[0]!, vec3(0.5 - flying.x, flying.y, -1 - flying.z))).toBeLessThan(1e-9);
  expect(distance(seen[1]!, vec3(-0.5, 1.2, 1))).toBeLessThan(1e-9);
});

describe('a ball that has not been told to be caught', () => {
  const opening = { position: vec3(0, 1.1, -4.5), normal: vec3(0, 1, 0) };
  const fresh = ballRules.start(['a', 'b', 'c'], 1);

  /**
   * How far above its flight it is drawn at most [m], thrown so that it comes to this height over or under the middle
   * of the opening.
   */
  function lifted(height: number): number {
    const at = vec3(0, opening.position.y + height, opening.position.z);
    const from = vec3(0, 1.5, -0.5);
    const launch = { time: 1, position: from, velocity: velocityTo(from, at, 1.2) };
    const balls = fresh.balls.map((place, ball) =>
      ball === 0 ? ({ on: 'air', launch, thrower: 0, missed: false } as const) : place,
    );
    const view = new Balls(20, 'low');
    const mesh = view.object.children[0] as InstancedMesh;
    const matrix = new Matrix4();
    let most = 0;
    for (let time = 1; time < 1 + fallTime(launch, ballRadius); time += 1 / 72) {
      view.show({ ...fresh, balls }, time, () => null, opening);
      mesh.getMatrixAt(0, matrix);
      const drawnAt = new Vector3().setFromMatrixPosition(matrix);
      most = Math.max(most, distance(drawnAt, ballInAir(launch, time)));
    }
    return most;
  }

  test('stays on the bottom of the basket that it fell into', () => {
    expect(lifted(0)).toBeGreaterThan(0.1);
  });

  test('passes under a basket that it did not come into', () => {
    for (const below of [-0.45, -0.6, -0.9]) expect(lifted(below)).toBeLessThan(1e-5);
  });
});
