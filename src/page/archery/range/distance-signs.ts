import { BoxGeometry, type BufferGeometry, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial } from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { drawText } from 'threepoint-ui/vr';
import { createLabelQuad } from '../../scene/boards/label-quad';
import { createCanvasTexture } from '../../scene/canvas-texture';
import { woodColor } from '../../scene/outdoors/wood-color';
import { merged, painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';

const signWidth = 0.56;
const signHeight = 0.28;
const cell = { width: 256, height: 128 };

/** Formats a distance for a sign: "4.5 m". */
const distanceLabel = (distance: number): string => `${Number(distance.toFixed(1))} m`;

function paintLabels(context: CanvasRenderingContext2D, labels: readonly string[]): void {
  labels.forEach((label, row) => {
    const y = row * cell.height;
    context.fillStyle = '#f6f1e2';
    context.fillRect(0, y, cell.width, cell.height);
    context.strokeStyle = '#1d2a33';
    context.lineWidth = 7;
    context.strokeRect(9, y + 9, cell.width - 18, cell.height - 18);
    const writing = { font: '700 74px', color: '#14202a', align: 'center', baseline: 'middle' } as const;
    drawText(context, label, [cell.width / 2, y + cell.height / 2 + 5], { ...writing, maxWidth: cell.width - 46 });
  });
}

/** Beyond the ropes and above them, where at most a few of them hide behind targets [m]. */
const aside = 4.5;
const middle = 1.08;

/** The position of a sign, and its rotation towards the archer. */
interface Place {
  readonly x: number;
  readonly z: number;
  readonly turn: number;
  readonly row: number;
}

function placesOf(distances: readonly number[]): Place[] {
  return [-1, 1].flatMap((side) =>
    distances.map((distance, row) => ({
      x: side * aside,
      z: -distance,
      turn: -Math.atan2(side * aside, distance + 3),
      row,
    })),
  );
}

/** One quad for each sign, each with its part of the texture. */
function faces(places: readonly Place[], rows: number): BufferGeometry {
  return mergeGeometries(
    places.map(({ x, z, turn, row }) =>
      createLabelQuad(signWidth, signHeight, row, rows).translate(0, 0, 0.016).rotateY(turn).translate(x, middle, z),
    ),
  );
}

/** Signs on both sides of the field at each distance [m] from the archer. Arena frame. */
export function createDistanceSigns(distances: readonly number[], quality: Quality): Group {
  const { texture, draw } = createCanvasTexture(cell.width, cell.height * distances.length, quality);
  draw((context) => paintLabels(context, distances.map(distanceLabel)));
  const places = placesOf(distances);
  const boards = places.flatMap(({ x, z, turn, row }) => {
    const board = new BoxGeometry(signWidth + 0.03, signHeight + 0.03, 0.024).rotateY(turn).translate(x, middle, z);
    const stake = new BoxGeometry(0.05, middle, 0.03).rotateY(turn).translate(x, middle / 2, z - 0.02);
    return [painted(board, woodColor(row)), painted(stake, woodColor(row + 1))];
  });
  const signs = new Group();
  signs.name = 'distance signs';
  const solid = new Mesh(merged(boards), new MeshLambertMaterial({ vertexColors: true }));
  solid.castShadow = true;
  solid.receiveShadow = true;
  signs.add(solid, new Mesh(faces(places, distances.length), new MeshBasicMaterial({ map: texture })));
  return signs;
}
