import { InstancedMesh, Matrix4, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { createBalls } from '../../../src/app/ball/balls';
import { ballRules, defaultBallOptions } from '../../../src/core/games/ball/rules';

/** The look of each ball that is drawn, and the side of the court it lies on: −1 left, 1 right. */
function drawn(count: number): { readonly look: number; readonly side: number }[] {
  const view = createBalls(defaultBallOptions.balls, 'low');
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
  'of %d balls those of the left rack look like the first, those of the right like the second',
  (count) => {
    const balls = drawn(count);
    expect(balls).toHaveLength(count);
    for (const { look, side } of balls) expect(look).toBe(side < 0 ? 0 : 1);
  },
);
