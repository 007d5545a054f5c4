import { Matrix4, Vector3 } from 'three';
import { addScaled, distance, dot, normalise, reject, subtract, vec3 } from 'threepoint/math';
import { positionAt, velocityAt } from 'threepoint-games';
import { type Arrow, arrowLength, type Landing } from 'threepoint-games/archery';
import { describe, expect, it } from 'vitest';
import { arrowPose } from '../../../src/page/archery/bow/arrow-pose';
import { arrowGeometry, createArrows } from '../../../src/page/archery/bow/arrows';
import { createTrails } from '../../../src/page/archery/bow/trails';

const release = { time: 2, position: vec3(0, 1.5, -0.8), velocity: vec3(1, 3, -30) };
const after = 0.3;
const landingOn = (on: Landing['on']): Landing => ({
  time: release.time + after,
  position: positionAt(release, after),
  direction: normalise(velocityAt(release, after)),
  on,
  target: on === 'target' ? 1 : null,
  points: on === 'target' ? 10 : 0,
});
const arrow = (landing: Landing | null, id = 0): Arrow => ({ id, release, landing });

describe('an arrow', () => {
  it('flies on its parabola and points where it goes', () => {
    for (const time of [2, 2.1, 2.25]) {
      const pose = arrowPose(arrow(null), time);
      expect(distance(pose.tip, positionAt(release, time - release.time))).toBeLessThan(1e-9);
      expect(dot(pose.direction, normalise(velocityAt(release, time - release.time)))).toBeCloseTo(1, 9);
    }
  });

  it('sticks where it landed, its tip a hand deep at most, for good', () => {
    for (const on of ['target', 'ground', 'wall'] as const) {
      const landing = landingOn(on);
      for (const since of [0, 0.01, 0.05, 0.4, 60]) {
        const { tip, direction } = arrowPose(arrow(landing), landing.time + since);
        expect(distance(reject(subtract(tip, landing.position), direction), vec3(0, 0, 0))).toBeLessThan(1e-9);
        const deep = dot(subtract(tip, landing.position), direction);
        expect(deep).toBeGreaterThan(0.03);
        expect(deep).toBeLessThan(0.25);
      }
    }
  });

  it('trembles for a moment after it lands and then stands still as it came', () => {
    const landing = landingOn('target');
    const off = (since: number) =>
      Math.acos(Math.min(1, dot(arrowPose(arrow(landing), landing.time + since).direction, landing.direction)));
    expect(Math.max(...[0.01, 0.02, 0.03, 0.05].map(off))).toBeGreaterThan(0.02);
    expect(off(1.5)).toBeLessThan(1e-4);
  });

  it('does not jump when it lands', () => {
    const landing = landingOn('ground');
    const before = arrowPose(arrow(landing), landing.time - 1e-4);
    const then = arrowPose(arrow(landing), landing.time);
    expect(distance(before.tip, then.tip)).toBeLessThan(0.1);
    expect(dot(before.direction, then.direction)).toBeGreaterThan(0.9999);
  });

  it('is drawn with its tip at the pose and its nock an arrow length behind', () => {
    const geometry = arrowGeometry(arrowLength);
    geometry.computeBoundingBox();
    expect(geometry.boundingBox?.min.z).toBeCloseTo(0, 6);
    expect(geometry.boundingBox?.max.z).toBeCloseTo(arrowLength, 6);
  });
});

describe('all arrows together', () => {
  it('draw the shot ones in place and the nocked one last until it is gone', () => {
    const arrows = createArrows(arrowLength);
    const landing = landingOn('target');
    const nocked = { tip: vec3(0.1, 1.4, -0.9), direction: normalise(vec3(0.2, 0.1, -1)) };
    arrows.show([arrow(landing)], landing.time + 9, nocked);
    expect(arrows.object.count).toBe(2);
    const [stuck, held] = [new Matrix4(), new Matrix4()];
    arrows.object.getMatrixAt(0, stuck);
    arrows.object.getMatrixAt(1, held);
    const tipOf = (matrix: Matrix4) => new Vector3().setFromMatrixPosition(matrix);
    expect(distance(tipOf(stuck), addScaled(landing.position, landing.direction, 0.085))).toBeLessThan(1e-4);
    expect(distance(tipOf(held), nocked.tip)).toBeLessThan(1e-6);
    expect(dot(new Vector3(0, 0, -1).transformDirection(held), nocked.direction)).toBeCloseTo(1, 6);
    arrows.show([arrow(landing)], landing.time + 9, null);
    expect(arrows.object.count).toBe(1);
  });

  it('never outgrow what was made for them', () => {
    const arrows = createArrows(arrowLength);
    const landing = landingOn('ground');
    arrows.show(
      Array.from({ length: 500 }, (_, id) => arrow(landing, id)),
      landing.time,
      { tip: vec3(0, 0, 0), direction: vec3(0, 0, -1) },
    );
    expect(arrows.object.count).toBeLessThanOrEqual(arrows.object.instanceMatrix.count);
  });
});

describe('a trail', () => {
  const seen = (time: number, landing: Landing | null) => {
    const trails = createTrails(arrowLength);
    trails.show([arrow(landing)], time, vec3(0, 1.6, 0));
    return trails.object.geometry.drawRange.count;
  };

  it('is there while the arrow flies and gone soon after it has landed', () => {
    const landing = landingOn('target');
    expect(seen(1.9, landing)).toBe(0);
    expect(seen(2.1, null)).toBeGreaterThan(0);
    expect(seen(landing.time + 0.1, landing)).toBeGreaterThan(0);
    expect(seen(landing.time + 1, landing)).toBe(0);
  });
});
