import {
  BoxGeometry,
  type BufferGeometry,
  type Camera,
  Group,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  PlaneGeometry,
  type Scene,
  UnsignedByteType,
  type WebGLRenderer,
} from 'three';
import { Reflector } from 'three/addons/objects/Reflector.js';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { eyeLayers } from './eye-layers';
import { Pace } from './frame-pacer';
import { reflectionSize } from './reflection-size';
import { thirdPersonOnlyLayer } from './rig/body-meshes';
import { seesRectangle } from './sees-rectangle';

export interface MirrorOptions {
  /** The distance ahead of the floor's origin, along −Z [m]. */
  readonly distance?: number;
  readonly width?: number;
  readonly height?: number;
  /**
   * The largest width of the reflection's texture [pixels]; a headset draws one for each eye, of at most half the eye's
   * pixels.
   */
  readonly resolution?: number;
  /** Samples per pixel of the reflection; 0 for software rendering. */
  readonly samples?: number;
}

const frameWidth = 0.035;
const frameDepth = 0.05;
const gapBelow = 0.06;

/**
 * The reflection is drawn with the very programs of the scene: into a texture whose colours are encoded as the canvas's
 * are (see `reflect`). Where they differed, three.js looked up the program of every material twice a frame, which left
 * 47 kB to the collector.
 */
const { ReflectorShader } = Reflector as unknown as { readonly ReflectorShader: Record<'fragmentShader', string> };
const shader = {
  ...ReflectorShader,
  name: 'MirrorShader',
  fragmentShader: ReflectorShader.fragmentShader.replace(
    'vec4 base = texture2DProj( tDiffuse, vUv );',
    'vec4 base = sRGBTransferEOTF( texture2DProj( tDiffuse, vUv ) );',
  ),
};

/**
 * A standing mirror that shows the room and the whole avatar, the own head included; each eye sees its own reflection.
 */
export class Mirror {
  readonly object: Object3D = new Group();
  /** One glass for each eye of a session; on a desktop the first only. */
  private readonly glasses: Reflector[] = [];
  private readonly reflections: Reflector['onBeforeRender'][] = [];
  private readonly width: number;
  private readonly height: number;
  private readonly resolution: number;
  private readonly samples: number;
  private readonly pace = new Pace();
  /** The textures take no memory. */
  private released = true;
  private readonly frame = new Mesh<BufferGeometry, MeshStandardMaterial>(
    undefined,
    new MeshStandardMaterial({ color: 0x2a2f38, roughness: 0.35, metalness: 0.7 }),
  );

  constructor({ distance = 1.8, width = 1.5, height = 2.15, resolution = 1024, samples = 4 }: MirrorOptions = {}) {
    this.width = width;
    this.height = height;
    this.resolution = resolution;
    this.samples = samples;
    this.object.name = 'mirror';
    this.object.position.set(0, gapBelow + height / 2 + frameWidth, -distance);
    this.addGlass();
    this.addFrame();
  }

  setVisible(visible: boolean): void {
    this.object.visible = visible;
  }

  /** Moves its middle to (x, z) [m], floor frame; turned by 0 it faces +Z, positive to +X [rad]. */
  place(x: number, z: number, turned: number): void {
    this.object.position.set(x, this.object.position.y, z);
    this.object.rotation.y = turned;
  }

  /** Draws at most so many reflections in a second of a session [Hz]; null: one in each frame. */
  setMostRate(rateHz: number | null): void {
    this.pace.rateHz = rateHz;
  }

  /**
   * Draws the reflection of the scene for this camera, or in a session for the eyes, at this time [s]. Call it before
   * the scene is drawn.
   */
  reflect(renderer: WebGLRenderer, scene: Scene, camera: Camera, time: number): void {
    const { xr } = renderer;
    if (!this.object.visible) {
      this.release();
      return;
    }
    if (!xr.isPresenting) {
      if (camera.parent === null) camera.updateMatrixWorld();
      for (let i = 1; i < this.glasses.length; i++) this.glasses[i]!.visible = false;
      this.glasses[0]!.layers.set(0);
      this.fitTarget(0, Number.POSITIVE_INFINITY);
      this.released = false;
      this.pace.restart();
      this.reflectTo(0, renderer, scene, camera);
      return;
    }
    if (!this.pace.isDue(time)) return;
    this.released = false;
    // three.js does this at the start of a frame in a session.
    xr.updateCamera(camera as Parameters<typeof xr.updateCamera>[0]);
    const { cameras } = xr.getCamera();
    for (let eye = 0; eye < cameras.length && eye < eyeLayers.length; eye++) {
      const { z: wide, w: high } = cameras[eye]!.viewport;
      // An emulated headset may have an eye without pixels.
      if (wide * high === 0) continue;
      if (!this.glasses[eye]) this.addGlass();
      this.glasses[eye]!.layers.set(eyeLayers[eye]!);
      this.fitTarget(eye, wide * high);
      this.reflectTo(eye, renderer, scene, cameras[eye]!);
    }
  }

  /** Frees the memory of the textures, tens of megabytes for each eye. The next reflection allocates it again. */
  private release(): void {
    if (this.released) return;
    this.released = true;
    this.pace.restart();
    for (const glass of this.glasses) glass.getRenderTarget().dispose();
  }

  /** Gives a glass a texture for a picture of this many pixels; infinity: the largest texture. */
  private fitTarget(index: number, pixels: number): void {
    const { width, height } = reflectionSize(pixels, this.height / this.width, this.resolution);
    const target = this.glasses[index]!.getRenderTarget();
    if (target.width !== width || target.height !== height) target.setSize(width, height);
  }

  dispose(): void {
    for (const glass of this.glasses) {
      glass.dispose();
      glass.geometry.dispose();
    }
    this.frame.geometry.dispose();
    this.frame.material.dispose();
    this.object.removeFromParent();
  }

  /** Draws a camera's view in one of the glasses, if it sees that glass. */
  private reflectTo(index: number, renderer: WebGLRenderer, scene: Scene, camera: Camera): void {
    const glass = this.glasses[index]!;
    glass.visible = true;
    glass.updateWorldMatrix(true, false);
    if (!seesRectangle(camera, glass.matrixWorld, this.width, this.height)) return;
    const target = glass.getRenderTarget();
    target.texture.colorSpace = renderer.outputColorSpace;
    // The mirror's back lies between the glass and the reflecting camera; clipping it away is not exact everywhere.
    this.object.visible = false;
    const { render } = renderer.info;
    const { frame } = render;
    this.reflections[index]!.call(
      glass,
      renderer,
      scene,
      camera,
      glass.geometry,
      glass.material as never,
      null as never,
    );
    // All renders of a frame have one number: bones are uploaded for the first of them only.
    render.frame = frame;
    this.object.visible = true;
  }

  private addGlass(): void {
    const glass = new Reflector(new PlaneGeometry(this.width, this.height), {
      textureWidth: this.resolution,
      textureHeight: Math.round((this.resolution * this.height) / this.width),
      clipBias: 0.003,
      multisample: this.samples,
      // Silvered glass takes a little of the light; #bcbcbc would take none.
      color: 0xb6b9bb,
      shader,
    });
    const target = glass.getRenderTarget();
    // three.js recognises by this property a target whose colours are encoded like a canvas's: it needs no more bits.
    Object.assign(target, { isXRRenderTarget: true });
    target.texture.type = UnsignedByteType;
    // In first person the own head lies on this layer alone: a mirror shows it all the same. What lies on the layers of
    // the eyes alone it does not show. The reflecting camera is a copy made on demand by a method that three's types
    // leave out.
    const cameras = glass as unknown as { getReflectionCamera(camera: Camera): Camera };
    const makeCamera = cameras.getReflectionCamera;
    cameras.getReflectionCamera = (camera) => {
      const reflecting = makeCamera.call(glass, camera);
      reflecting.layers.enable(thirdPersonOnlyLayer);
      for (const eye of eyeLayers) reflecting.layers.disable(eye);
      return reflecting;
    };
    this.reflections.push(glass.onBeforeRender);
    // The reflection is drawn before the scene: a nested render has lights of its own, and every material would be
    // looked up again.
    glass.onBeforeRender = () => undefined;
    this.glasses.push(glass);
    this.object.add(glass);
  }

  /** Merges bars and back into one mesh: each drawn mesh allocates half a kilobyte in every frame. */
  private addFrame(): void {
    const { width, height } = this;
    const bar = (across: number, up: number, x: number, y: number): BufferGeometry =>
      new BoxGeometry(across, up, frameDepth).translate(x, y, -frameDepth / 2 + 0.006);
    const wide = width + 2 * frameWidth;
    const parts = [
      bar(wide, frameWidth, 0, (height + frameWidth) / 2),
      bar(wide, frameWidth, 0, -(height + frameWidth) / 2),
      bar(frameWidth, height, (width + frameWidth) / 2, 0),
      bar(frameWidth, height, -(width + frameWidth) / 2, 0),
      new PlaneGeometry(wide, height + 2 * frameWidth).rotateY(Math.PI).translate(0, 0, -0.01),
    ];
    this.frame.geometry = mergeGeometries(parts);
    for (const part of parts) part.dispose();
    this.object.add(this.frame);
  }
}
