import { readFileSync } from 'node:fs';
import { NodeIO, type Primitive } from '@gltf-transform/core';
import { validateBytes } from 'gltf-validator';
import { beforeAll, describe, expect, test } from 'vitest';
import { figures } from '../../../tools/avatars/build/bodies';
import { buildBody } from '../../../tools/avatars/build/build-body';
import { isNightly } from '../../nightly';

interface Vertex {
  readonly position: readonly number[];
  /** How far it goes for each shape that its mesh has, by the shape's name. */
  readonly moves: Readonly<Record<string, readonly number[]>>;
  readonly weights: readonly number[];
}

describe.each(figures.map((figure) => [figure.name, figure] as const))('the %s', (name, figure) => {
  const file = readFileSync(new URL(`../../../public/avatars/${name}.vrm`, import.meta.url));

  /** All triangles of all primitives, each corner by a key of its position: seams between materials close again. */
  let corners: string[] = [];
  let vertices: Vertex[] = [];

  beforeAll(async () => {
    const document = await new NodeIO().readBinary(file);
    const primitives = document
      .getRoot()
      .listMeshes()
      .flatMap((mesh) => {
        const names = (mesh.getExtras().targetNames ?? []) as string[];
        return mesh.listPrimitives().map((primitive): [Primitive, string[]] => [primitive, names]);
      });
    corners = [];
    vertices = [];
    for (const [primitive, names] of primitives) {
      const positions = primitive.getAttribute('POSITION');
      const weights = primitive.getAttribute('WEIGHTS_0');
      const indices = primitive.getIndices();
      const targets = primitive
        .listTargets()
        .map((target, i) => [names[i] ?? '', target.getAttribute('POSITION')] as const);
      if (!positions || !weights || !indices) throw new Error('a primitive without positions, weights or indices');
      const own: Vertex[] = [];
      for (let i = 0; i < positions.getCount(); i++) {
        own.push({
          position: positions.getElement(i, []),
          weights: weights.getElement(i, []),
          moves: Object.fromEntries(targets.map(([name, moved]) => [name, moved?.getElement(i, []) ?? []])),
        });
      }
      vertices.push(...own);
      for (let i = 0; i < indices.getCount(); i++) {
        corners.push((own[indices.getScalar(i)]?.position ?? []).map((value) => value.toFixed(6)).join());
      }
    }
  });

  test('is a VRM 1.0 file that the Khronos validator finds nothing wrong with', async () => {
    const report = await validateBytes(new Uint8Array(file), { ignoredIssues: ['UNSUPPORTED_EXTENSION'] });
    expect(report.issues.messages.filter(({ severity }) => severity === 0)).toEqual([]);
    expect(report.info.extensionsUsed).toContain('VRMC_vrm');
  });

  test('has 12,000 to 18,000 triangles in less than 640 kB', () => {
    expect(corners.length / 3).toBeGreaterThan(12_000);
    expect(corners.length / 3).toBeLessThanOrEqual(18_000);
    expect(file.byteLength).toBeLessThan(640e3);
  });

  test('is one closed surface and its eyeballs: each edge is passed equally both ways', () => {
    const edges = new Map<string, number>();
    const group = new Map<string, string>();
    const root = (key: string): string => {
      let at = key;
      for (let above = group.get(at); above !== undefined && above !== at; above = group.get(at)) {
        // Halves the path for the next look: without it the search is quadratic in the triangles.
        const aboveThat = group.get(above) ?? above;
        group.set(at, aboveThat);
        at = aboveThat;
      }
      return at;
    };
    for (let t = 0; t < corners.length; t += 3) {
      const triangle = corners.slice(t, t + 3);
      for (let e = 0; e < 3; e++) {
        const [a = '', b = ''] = [triangle[e], triangle[(e + 1) % 3]];
        const edge = a < b ? `${a}|${b}` : `${b}|${a}`;
        edges.set(edge, (edges.get(edge) ?? 0) + (a < b ? 1 : -1));
        group.set(root(a), root(b));
      }
    }
    expect([...edges.values()].filter((balance) => balance !== 0)).toHaveLength(0);
    expect(new Set(corners.map(root)).size).toBe(1 + (figure.pieces?.length ?? 0));
  });

  test('stands on the floor, about 1.70 m tall, as wide to the left as right', () => {
    const of = (axis: number) => vertices.map(({ position }) => position[axis] ?? Number.NaN);
    expect(Math.min(...of(1))).toBeGreaterThan(-0.004);
    expect(Math.min(...of(1))).toBeLessThan(0.004);
    expect(Math.max(...of(1))).toBeGreaterThan(1.66);
    expect(Math.max(...of(1))).toBeLessThan(1.8);
    expect(Math.max(...of(0)) + Math.min(...of(0))).toBeCloseTo(0, 2);
  });

  test('gives every vertex weights that sum to 1', () => {
    for (const { weights } of vertices) expect(weights.reduce((sum, weight) => sum + weight, 0)).toBeCloseTo(1, 5);
  });

  test('has every bone of the humanoid, fingers included', () => {
    const json = JSON.parse(new TextDecoder().decode(file.subarray(20, 20 + file.readUInt32LE(12))));
    const { humanBones } = json.extensions.VRMC_vrm.humanoid;
    const { bones } = figure.rig;
    expect(Object.keys(humanBones).sort()).toEqual(bones.map(({ name }) => name).sort());
    for (const [name, { node }] of Object.entries<{ node: number }>(humanBones))
      expect(json.nodes[node].name).toBe(name);
    expect(bones).toHaveLength(6 + 2 * (4 + 15 + 4 + (figure.pieces ? 1 : 0)));
  });

  test.runIf(figure.pieces)('has eyes at 1.59 m and a head of more than a sixth of its height', () => {
    const [eye] = figure.rig.bones.flatMap(({ name, joint }) => (name === 'leftEye' ? [joint] : []));
    expect(eye?.[1]).toBeCloseTo(1.594, 3);
    const face = vertices.filter(({ moves }) => Math.abs(moves.aa?.[1] ?? 0) > 0.005);
    const chin = Math.min(...face.map(({ position: [, y = 0] }) => y));
    const crown = Math.max(...vertices.map(({ position: [, y = 0] }) => y));
    expect((crown - chin) / crown).toBeGreaterThan(1 / 6);
    expect((crown - chin) / crown).toBeLessThan(1 / 5);
  });

  /**
   * Meshes that an expression moves, and how many vertices of theirs it moves and leaves; `where`: looks at each that
   * moves.
   */
  function shapeOf(name: string, where: (vertex: Vertex, far: number) => void) {
    const json = JSON.parse(new TextDecoder().decode(file.subarray(20, 20 + file.readUInt32LE(12))));
    const binds: { node: number; index: number }[] = json.extensions.VRMC_vrm.expressions.preset[name].morphTargetBinds;
    for (const { node, index } of binds)
      expect(json.meshes[json.nodes[node].mesh].extras.targetNames[index], 'the shape that is bound').toBe(name);
    const moving = vertices.filter(({ moves }) => Math.hypot(...(moves[name] ?? [])) > 0);
    for (const vertex of moving) where(vertex, Math.hypot(...(vertex.moves[name] ?? [])));
    return {
      meshes: binds.map(({ node }) => json.nodes[node].name),
      moved: moving.length,
      still: vertices.length - moving.length,
    };
  }

  test.runIf(figure.shapes.blink)('blinks: its eyes have a shape of closed lids, which moves nothing else', () => {
    const { meshes, moved, still } = shapeOf('blink', ({ position: [x = 0, y = 0, z = 0] }, far) => {
      expect(far).toBeLessThan(0.035);
      expect(Math.abs(x)).toBeLessThan(0.1);
      expect(y).toBeGreaterThan(1.55);
      expect(z).toBeGreaterThan(0);
    });
    expect(meshes).toEqual(['faceSkin']);
    expect(moved).toBeGreaterThan(100);
    expect(still).toBeGreaterThan(4000);
  });

  test.runIf(figure.shapes.happy)('shows by its face alone what it feels', () => {
    for (const shape of ['happy', 'relaxed', 'surprised']) {
      const { meshes, moved } = shapeOf(shape, ({ position: [, y = 0] }, far) => {
        expect(far).toBeLessThan(0.02);
        expect(y).toBeGreaterThan(1.45);
      });
      expect(meshes).toEqual(['faceSkin']);
      expect(moved).toBeGreaterThan(100);
    }
  });

  test.runIf(figure.pieces)('has lids that lie before its eyeballs, open and closed', () => {
    const { centre, surface } = figure.pieces![0]!;
    const away = (place: readonly number[]) => Math.hypot(...place.map((value, axis) => value - centre[axis]!));
    const ball = away([...surface.positions.subarray(0, 3)]);
    const lids = vertices.filter(({ position: [x = 0], moves }) => x > 0 && Math.hypot(...(moves.blink ?? [])) > 0.006);
    expect(lids.length).toBeGreaterThan(20);
    for (const { position, moves } of lids) {
      expect(away(position)).toBeGreaterThan(ball);
      expect(away(position.map((value, axis) => value + moves.blink![axis]!))).toBeGreaterThan(ball);
    }
  });

  test('says "ah": chin and lower lip fall, the upper lip hardly moves, eyes and neck stay', () => {
    let [chin, lowest] = [0, Number.POSITIVE_INFINITY];
    const { moved } = shapeOf('aa', ({ position: [x = 0, y = 0, z = 0], moves }, far) => {
      const [, down = 0] = moves.aa ?? [];
      expect(far).toBeLessThan(0.035);
      // Nothing but the upper lip rises, and that by two millimetres.
      expect(down).toBeLessThan(0.0025);
      expect(y).toBeGreaterThan(1.44);
      expect(y).toBeLessThan(1.6);
      expect(z).toBeGreaterThan(-0.02);
      if (Math.abs(x) < 0.01 && z > 0.04 && y < lowest) [chin, lowest] = [down, y];
    });
    expect(moved).toBeGreaterThan(150);
    const lip = vertices.filter(({ position: [x = 0], moves }) => Math.abs(x) < 0.01 && (moves.aa?.[1] ?? 0) < -0.008);
    expect(lip.length, 'lower lip and chin go down by a centimetre').toBeGreaterThan(10);
    expect(chin, 'what lies under the chin goes along').toBeLessThan(0);
  });

  test('opens its mouth to both sides alike: the middle of the face stays there', () => {
    const middle = vertices.filter(({ position: [x = 0], moves }) => moves.aa && Math.abs(x) < 0.006);
    expect(middle.length).toBeGreaterThan(20);
    for (const { moves } of middle) expect(Math.abs(moves.aa?.[0] ?? 0)).toBeLessThan(1e-3);
  });

  test('has shoulders sloping to the acromion, 4 to 5.5 cm above joint, and no higher deltoid', () => {
    const { shoulder } = figure.rig.armJoints;
    /** The highest skin so far out from the shoulder joint, below the head [m]. */
    const top = (from: number, to: number) =>
      Math.max(
        ...vertices.flatMap(({ position: [x = 0, y = 0] }) =>
          x > shoulder + from && x < shoulder + to && y < 1.5 ? [y] : [],
        ),
      ) - figure.rig.armHeight;
    const acromion = top(-0.02, 0.015);
    expect(acromion).toBeGreaterThan(0.035);
    expect(acromion).toBeLessThan(0.055);
    expect(top(0.015, 0.09)).toBeLessThan(acromion + 1e-3);
    expect(top(-0.08, -0.06)).toBeGreaterThan(acromion + 0.008);
  });

  test('has skin at its elbows that is fine enough to bend: no edge of 3 cm', () => {
    const { elbow } = figure.rig.armJoints;
    const places = corners.map((corner) => corner.split(',').map(Number));
    let found = 0;
    for (let t = 0; t < places.length; t += 3) {
      const [a = [], b = [], c = []] = places.slice(t, t + 3);
      for (const [[ax = 0, ay = 0, az = 0], [bx = 0, by = 0, bz = 0]] of [
        [a, b],
        [b, c],
        [c, a],
      ] as [number[], number[]][]) {
        if (Math.abs(Math.abs(ax + bx) / 2 - elbow) > 0.035 || ay < figure.rig.armHeight - 0.1) continue;
        found += 1;
        expect(Math.hypot(bx - ax, by - ay, bz - az)).toBeLessThan(0.03);
      }
    }
    expect(found).toBeGreaterThan(200);
  });

  // A minute of a core, and nothing that changes by the day.
  if (isNightly) {
    test('comes out of its script byte by byte', { timeout: 240_000 }, async () => {
      expect(Buffer.from(await buildBody(figure)).equals(file)).toBe(true);
    });
  }
});
