// The page of `npm run tool -- avatars:try`: one file in, a sheet of pictures out.

import { AmbientLight, Color, DirectionalLight, GridHelper, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { defaultCalibration, reasonOf, type TrackingFrame } from 'threepoint/core';
import { checkInWorker, parseChecked } from 'threepoint/files';
import { thirdPersonOnlyLayer } from 'threepoint/internal/three';
import type { Avatar } from 'threepoint/three';
import { decoders } from '../../../src/page/scene/decoders';
import { createAvatar } from '../../../src/threepoint/avatar/avatar';
import { trackerAtJoint } from '../../../src/threepoint/core/body/tracker-offsets';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { pinning } from '../../../src/threepoint/core/estimation/pinning';
import { postures, trackedPostures } from './postures';

/** A picture [pixels] on the sheet, and the line of text above all. */
const width = 330;
const height = 430;
const headline = 34;
const allPostures = [...postures, ...trackedPostures];
/** Postures side by side; each is seen from three sides. */
const columns = 6;
const sides = 3;
/** A body's picture [pixels] in the row of all bodies of a folder. */
const bodyWidth = 300;
const bodyHeight = 520;
/** Postures with trackers state the joints themselves. */
const trackerOffsets = { hips: trackerAtJoint, leftFoot: trackerAtJoint, rightFoot: trackerAtJoint };
/** The time a posture is held before its picture [s], and the frame rate until then [Hz]. */
const heldSeconds = 2;
const rateHz = 30;

export interface Sheet {
  /** data: addresses of PNGs: the sheet, and the body alone that waves, where there is one. */
  readonly picture: string;
  readonly waving: string | null;
  /** null: the file was opened. */
  readonly refused: string | null;
  /** From bytes to a body [ms]; 0: there is none. */
  readonly loadMs: number;
}

declare global {
  interface Window {
    makeSheet(address: string, name: string): Promise<Sheet>;
    /** The pictures of bodies side by side; a data: address of a PNG. */
    makeRow(waving: readonly string[]): Promise<string>;
  }
}

const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(width, height, false);

function createScene(): Scene {
  const scene = new Scene();
  scene.background = new Color('#cfd6de');
  const sun = new DirectionalLight('#ffffff', 2.4);
  sun.position.set(1, 3, -2.5);
  scene.add(new AmbientLight('#ffffff', 1.3), sun, new GridHelper(4, 8, '#8b95a1', '#b3bcc6'));
  return scene;
}

/** Holds a posture until filters, feet and hair have come to rest. */
function hold(avatar: Avatar, frame: TrackingFrame, from: number): void {
  const estimator = createIk({ ...defaultCalibration, trackerOffsets }, { pinning });
  for (let step = 0; step < heldSeconds * rateHz; step++) {
    const time = from + step / rateHz;
    avatar.setPose(estimator.update({ ...frame, time }).pose, time);
  }
}

/** From so far to the right [m] and ahead [m]; hands spread or raised are in the picture. */
function fromOutside(x: number, z: number, aspect = width / height): PerspectiveCamera {
  const camera = new PerspectiveCamera(38, aspect, 0.05, 20);
  camera.position.set(x, 1.3, z);
  camera.lookAt(0, 1.08, 0);
  camera.layers.enable(thirdPersonOnlyLayer);
  return camera;
}

/** What the wearer sees who looks down by so much [rad]. */
function fromInside({ position }: TrackingFrame['head'], down: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(95, width / height, 0.02, 20);
  camera.position.set(position.x, position.y, position.z);
  camera.rotation.x = -down;
  return camera;
}

/** How far the wearer looks down [rad] on a picture of a posture through the own eyes. */
const ownEyes: Readonly<Record<string, number>> = { crouch: 0.75, 'bow drawn': 0.2 };

function shoot(
  sheet: CanvasRenderingContext2D,
  scene: Scene,
  camera: PerspectiveCamera,
  { column, row, text }: { column: number; row: number; text: string },
): void {
  renderer.render(scene, camera);
  const top = headline + row * height;
  sheet.drawImage(renderer.domElement, column * width, top);
  sheet.fillText(text, column * width + 8, top + 20);
}

/** The body as it stands now, alone on a picture. */
function shootAlone(scene: Scene): string {
  renderer.setSize(bodyWidth, bodyHeight, false);
  renderer.render(scene, fromOutside(-0.9, -3.4, bodyWidth / bodyHeight));
  const picture = renderer.domElement.toDataURL('image/png');
  renderer.setSize(width, height, false);
  return picture;
}

async function draw(sheet: CanvasRenderingContext2D, address: string, name: string) {
  const bytes = await (await fetch(address)).arrayBuffer();
  const began = performance.now();
  const checked = await checkInWorker(bytes, { name, supportedCompressions: Object.keys(decoders) });
  const avatar = createAvatar(await parseChecked(checked, { decoders }));
  const loadMs = performance.now() - began;
  const scene = createScene();
  scene.add(avatar.object);
  const outside = [fromOutside(-0.9, -3.8), fromOutside(-3.9, -0.3), fromOutside(1.2, 3.7)];
  let seenFromInside = 0;
  let waving: string | null = null;
  for (const [index, { name: posture, frame }] of allPostures.entries()) {
    avatar.setFirstPerson(false);
    // The feet stand where each posture puts them, not where the one before left them.
    avatar.setCalibration(defaultCalibration);
    hold(avatar, frame, index * 10);
    const [column, band] = [index % columns, Math.floor(index / columns)];
    for (const [side, camera] of outside.entries()) {
      shoot(sheet, scene, camera, { column, row: band * sides + side, text: posture });
    }
    if (posture === 'wave') waving = shootAlone(scene);
    const down = ownEyes[posture];
    if (down === undefined) continue;
    avatar.setFirstPerson(true);
    const row = seenFromInside++;
    const text = `${posture}, own eyes`;
    shoot(sheet, scene, fromInside(frame.head, down), { column: columns, row, text });
  }
  avatar.dispose();
  return { loadMs, waving, notes: avatar.notes };
}

window.makeSheet = async (address, name) => {
  const canvas = document.createElement('canvas');
  canvas.width = width * (columns + 1);
  canvas.height = headline + Math.ceil(allPostures.length / columns) * sides * height;
  const sheet = canvas.getContext('2d');
  if (!sheet) throw new Error('no 2D canvas');
  sheet.fillStyle = '#ffffff';
  sheet.fillRect(0, 0, canvas.width, canvas.height);
  sheet.fillStyle = '#20242a';
  sheet.font = '15px sans-serif';
  let refused: string | null = null;
  let drawn: Awaited<ReturnType<typeof draw>> = { loadMs: 0, waving: null, notes: [] };
  try {
    drawn = await draw(sheet, address, name);
  } catch (error) {
    refused = reasonOf(error);
  }
  sheet.fillText(refused ?? name, 8, 23, canvas.width - 16);
  return { picture: canvas.toDataURL('image/png'), refused, ...drawn };
};

window.makeRow = async (waving) => {
  const canvas = document.createElement('canvas');
  canvas.width = bodyWidth * waving.length;
  canvas.height = bodyHeight;
  const row = canvas.getContext('2d');
  if (!row) throw new Error('no 2D canvas');
  for (const [column, address] of waving.entries()) {
    const picture = new Image();
    picture.src = address;
    await picture.decode();
    row.drawImage(picture, column * bodyWidth, 0);
  }
  return canvas.toDataURL('image/png');
};
