import { BoxGeometry, type Camera, Group, Mesh, MeshStandardMaterial, type Object3D, PlaneGeometry } from 'three';
import { Reflector } from 'three/examples/jsm/objects/Reflector.js';
import { eyeLayers } from '../scene/eye-layers';
import { thirdPersonOnlyLayer } from './avatar';

export interface MirrorOptions {
  /** How far ahead of the floor's origin, along −Z, it stands [m]. */
  readonly distance?: number;
  readonly width?: number;
  readonly height?: number;
  /** Pixels across the reflection's texture; a headset draws it once for each eye. */
  readonly resolution?: number;
  /** Samples per pixel of the reflection; 0 for software rendering. */
  readonly samples?: number;
}

/** A standing mirror that shows the room and the whole avatar, the own head included; each eye sees its own reflection. */
export interface Mirror {
  readonly object: Object3D;
  setVisible(visible: boolean): void;
  /** Stands it with its middle at (x, z) [m], floor frame; turned 0 it faces +Z, positive to +X [rad]. */
  place(x: number, z: number, turned: number): void;
  dispose(): void;
}

const frameWidth = 0.035;
const frameDepth = 0.05;
const gapBelow = 0.06;

export function createMirror({
  distance = 1.8,
  width = 1.5,
  height = 2.15,
  resolution = 1024,
  samples = 4,
}: MirrorOptions = {}): Mirror {
  const object = new Group();
  object.name = 'mirror';
  object.position.set(0, gapBelow + height / 2 + frameWidth, -distance);

  const glass = new Reflector(new PlaneGeometry(width, height), {
    textureWidth: resolution,
    textureHeight: Math.round((resolution * height) / width),
    clipBias: 0.003,
    multisample: samples,
    // Silvered glass takes a little of the light; #bcbcbc would take none.
    color: 0xb6b9bb,
  });
  // In first person the own head lies on this layer alone: a mirror shows it all the same. What lies on the layers of the eyes alone
  // it does not show. One reflecting camera per eye, a copy of it made on demand by a method that three's types leave out.
  const cameras = glass as unknown as { getReflectionCamera(camera: Camera): Camera };
  const makeCamera = cameras.getReflectionCamera;
  cameras.getReflectionCamera = (camera) => {
    const reflecting = makeCamera.call(glass, camera);
    reflecting.layers.enable(thirdPersonOnlyLayer);
    for (const eye of eyeLayers) reflecting.layers.disable(eye);
    return reflecting;
  };
  object.add(glass);

  // What holds the glass lies between it and the reflecting camera; clipping it away is not exact everywhere.
  const mount = new Group();
  object.add(mount);
  const reflect = glass.onBeforeRender;
  glass.onBeforeRender = (...args) => {
    mount.visible = false;
    reflect.apply(glass, args);
    mount.visible = true;
  };

  const frameMaterial = new MeshStandardMaterial({ color: 0x2a2f38, roughness: 0.35, metalness: 0.7 });
  const bar = (across: number, up: number, x: number, y: number): void => {
    const mesh = new Mesh(new BoxGeometry(across, up, frameDepth), frameMaterial);
    mesh.position.set(x, y, -frameDepth / 2 + 0.006);
    mount.add(mesh);
  };
  bar(width + 2 * frameWidth, frameWidth, 0, (height + frameWidth) / 2);
  bar(width + 2 * frameWidth, frameWidth, 0, -(height + frameWidth) / 2);
  bar(frameWidth, height, (width + frameWidth) / 2, 0);
  bar(frameWidth, height, -(width + frameWidth) / 2, 0);
  const back = new Mesh(new PlaneGeometry(width + 2 * frameWidth, height + 2 * frameWidth), frameMaterial);
  back.rotation.y = Math.PI;
  back.position.z = -0.01;
  mount.add(back);

  return {
    object,
    place(x, z, turned) {
      object.position.set(x, object.position.y, z);
      object.rotation.y = turned;
    },
    setVisible(visible) {
      object.visible = visible;
    },
    dispose() {
      glass.dispose();
      glass.geometry.dispose();
      frameMaterial.dispose();
      object.removeFromParent();
    },
  };
}
