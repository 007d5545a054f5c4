import {
  type BufferGeometry,
  Color,
  type Mesh,
  type Object3D,
  Scene,
  Vector3,
  WebGLCoordinateSystem,
  type WebGLRenderer,
  type WebGLRenderTarget,
} from 'three';
import { identity } from 'threepoint/core/math/quat';
import { zero } from 'threepoint/core/math/vec3';
import { daylight } from 'threepoint-page/scene/outdoors/daylight';
import { createStudio } from 'threepoint-page/studio/studio';
import { expect, test } from 'vitest';

type Held = BufferGeometry | WebGLRenderTarget;

/** A graphics device that draws nothing and keeps the books on what it was given and not given back. */
function device() {
  const held = new Set<Held>();
  const known = new Set<Held>();
  const take = (what: Held) => {
    if (known.has(what)) return;
    known.add(what);
    held.add(what);
    (what as BufferGeometry).addEventListener('dispose', () => void held.delete(what));
  };
  const renderer = {
    xr: { enabled: true },
    autoClear: true,
    coordinateSystem: WebGLCoordinateSystem,
    getRenderTarget: () => null,
    getActiveCubeFace: () => 0,
    getActiveMipmapLevel: () => 0,
    getClearColor: () => new Color(),
    setRenderTarget(target: WebGLRenderTarget | null) {
      if (target) take(target);
    },
    render(drawn: Object3D) {
      drawn.traverse((node) => {
        const { geometry } = node as Mesh;
        if (geometry) take(geometry);
      });
    },
    compile: () => undefined,
  };
  return { renderer: renderer as unknown as WebGLRenderer, held };
}

test('going from place to place leaves the graphics device one place’s reflections, and none of what made them', () => {
  const { renderer, held } = device();
  const studio = createStudio(renderer, 'high');
  const field = {
    quality: 'high',
    towardsSun: new Vector3(1, 2, 1),
    sunIntensity: 3,
    skyIntensity: 0.5,
    groundColor: '#5f7a35',
    shadows: { middle: new Vector3(), halfSize: 4 },
  } as const;
  const outdoors = { object: new Scene(), lighting: daylight(field, { position: zero, orientation: identity }) };
  for (let i = 0; i < 3; i++) {
    studio.setSurroundings(outdoors);
    studio.setSurroundings(null);
  }
  expect([...held].map((what) => what.constructor.name)).toEqual(['WebGLCubeRenderTarget']);
});
