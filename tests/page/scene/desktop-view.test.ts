import { vec3 } from 'threepoint/math';
import { beforeEach, expect, test, vi } from 'vitest';
import { DesktopView } from '../../../src/page/scene/desktop-view';

const [innerWidth, innerHeight] = [1280, 720];

/** The part of a canvas that its controls listen to. */
function canvas(): HTMLCanvasElement {
  const element = new EventTarget();
  const size = {
    clientWidth: innerWidth,
    clientHeight: innerHeight,
    style: {},
    getRootNode: () => element,
    ownerDocument: element,
  };
  return Object.assign(element, size) as unknown as HTMLCanvasElement;
}

beforeEach(() => {
  vi.stubGlobal('window', Object.assign(new EventTarget(), { innerWidth, innerHeight }));
});

const pelvis = vec3(0, 1, 0);
const eyes = { position: vec3(0, 1.6, 0), orientation: { x: 0, y: 0, z: 0, w: 1 } };

/** Returns the box of bodies that stand this far to the right of the first one [m], beside panels at both sides. */
function boxOf(places: readonly number[], view: 'front' | 'third-person') {
  const insets = { left: 360, right: 350, top: 20, bottom: 90 };
  const desk = new DesktopView(canvas());
  desk.setView(view);
  desk.setInsets(insets);
  const last = places.at(-1) ?? 0;
  desk.setBodies(1.7, last);
  // The camera takes some time to where it goes.
  for (let frames = 0; frames < 200; frames++) desk.update({ ...pelvis, x: last / 2 }, eyes, 0.1);
  desk.camera.updateMatrixWorld();
  const box = desk.boxOf(places.flatMap((x) => [vec3(x - 0.25, 0.1, 0), vec3(x + 0.25, 1.75, 0)]));
  return { box, free: { left: insets.left, right: innerWidth - insets.right, bottom: innerHeight - insets.bottom } };
}

test.each(['front', 'third-person'] as const)('the view from %s shows two bodies beside the panels', (view) => {
  const { box, free } = boxOf([0, 1.15], view);
  expect(box.left).toBeGreaterThan(free.left);
  expect(box.right).toBeLessThan(free.right);
  expect(box.bottom).toBeLessThan(free.bottom);
  const alone = boxOf([0], view).box;
  expect(alone.left).toBeGreaterThan(free.left);
  expect(alone.bottom - alone.top).toBeGreaterThan(box.bottom - box.top);
});
