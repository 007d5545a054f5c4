import {
  BoxGeometry,
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
} from 'three';
import { createDrawnTexture } from '../../scene/drawn-texture';
import { merged, painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';
import { field } from './field';
import { signFont } from './lettering';
import { woodColor } from './wood';

const signWidth = 0.56;
const signHeight = 0.28;
const cell = { width: 256, height: 128 };

/** A distance as a sign says it: "4.5 m". */
export const distanceLabel = (distance: number): string => `${Number(distance.toFixed(1))} m`;

function paintLabels(context: CanvasRenderingContext2D, labels: readonly string[]): void {
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  labels.forEach((label, row) => {
    const y = row * cell.height;
    context.fillStyle = '#f6f1e2';
    context.fillRect(0, y, cell.width, cell.height);
    context.strokeStyle = '#1d2a33';
    context.lineWidth = 7;
    context.strokeRect(9, y + 9, cell.width - 18, cell.height - 18);
    context.fillStyle = '#14202a';
    context.font = `700 74px ${signFont}`;
    context.fillText(label, cell.width / 2, y + cell.height / 2 + 5);
  });
}

/** One quad for each sign, each with its part of the texture; all turned a little towards the archer. */
function faces(distances: readonly number[], x: number): BufferGeometry {
  const positions: number[] = [];
  const uvs: number[] = [];
  distances.forEach((distance, row) => {
    const angle = -Math.atan2(x, distance + 3);
    const right = { x: Math.cos(angle), z: -Math.sin(angle) };
    const low = 0.52;
    const corner = (u: number, v: number) => {
      positions.push(
        x + right.x * (u - 0.5) * signWidth + Math.sin(angle) * 0.016,
        low + v * signHeight,
        -distance + right.z * (u - 0.5) * signWidth + Math.cos(angle) * 0.016,
      );
      uvs.push(u, 1 - (row + 1 - v) / distances.length);
    };
    for (const [u, v] of [
      [0, 0],
      [1, 0],
      [1, 1],
      [0, 0],
      [1, 1],
      [0, 1],
    ] as const)
      corner(u, v);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
  geometry.setAttribute('uv', new Float32BufferAttribute(uvs, 2));
  return geometry;
}

/** A sign by the rope at each distance [m] from the archer. Arena frame. */
export function createDistanceSigns(distances: readonly number[], quality: Quality): Group {
  const x = field.halfWidth - 0.45;
  const { texture, draw } = createDrawnTexture(cell.width, cell.height * distances.length, quality);
  draw((context) => paintLabels(context, distances.map(distanceLabel)));
  const boards = distances.flatMap((distance) => {
    const angle = -Math.atan2(x, distance + 3);
    const board = new BoxGeometry(signWidth + 0.03, signHeight + 0.03, 0.024)
      .rotateY(angle)
      .translate(x, 0.66, -distance);
    const stake = new BoxGeometry(0.05, 0.62, 0.03).rotateY(angle).translate(x, 0.3, -distance - 0.02);
    return [painted(board, woodColor(distance)), painted(stake, woodColor(distance + 1))];
  });
  const signs = new Group();
  signs.name = 'distance signs';
  const solid = new Mesh(merged(boards), new MeshLambertMaterial({ vertexColors: true }));
  solid.castShadow = true;
  solid.receiveShadow = true;
  signs.add(solid, new Mesh(faces(distances, x), new MeshBasicMaterial({ map: texture })));
  return signs;
}
