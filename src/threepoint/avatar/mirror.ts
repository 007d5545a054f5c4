import {
  BoxGeometry,
  type BufferGeometry,
  type Camera,
  Group,
  type Material,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  PlaneGeometry,
  type Scene,
  UnsignedByteType,
  Vector2,
  type WebGLRenderer,
  type WebGLRenderTarget,
} from 'three';
import { Reflector } from 'three/addons/objects/Reflector.js';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { eyeLayers } from './eye-layers';
import { thirdPersonOnlyLayer } from './rig/body-meshes';

interface MirrorOptions {
  /** The distance ahead of the floor's origin, along −Z [m]. */
  readonly distance?: number;
  readonly width?: number;
  readonly height?: number;
  /** The largest width of the reflection [pixels]; default: it has the pixels of the picture that shows it. */
  readonly resolution?: number;
  /** Samples per pixel of the reflection; 0 for software rendering. */
  readonly samples?: number;
  /** The material of the frame, which the mirror disposes; default: dark metal. */
  readonly frame?: MeshStandardMaterial;
}

const frameWidth = 0.035;
const frameDepth = 0.05;
const gapBelow = 0.06;

/**
 * The reflection is drawn with the shader programs of the scene, into a texture with the canvas's colour space (see
 * `reflect`). With another colour space three.js looks up the program of every material twice a frame, which allocates
 * 47 kB.
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

/** A standing mirror that shows the room and the whole avatar, including its head. Each eye has its own reflection. */
export class Mirror {
  readonly object: Object3D = new Group();
  /** The reflectors, one for each eye of a session; on a desktop only the first. */
  private readonly glasses: Reflector[] = [];
  private readonly reflections: Reflector['onBeforeRender'][] = [];
  private readonly width: number;
  private readonly height: number;
  private readonly resolution: number;
  private readonly samples: number;
  private readonly pace = new FramePacer();
  /** The textures take no memory. */
  private released = true;
  private readonly frame: Mesh<BufferGeometry, MeshStandardMaterial>;

  constructor({
    distance = 1.8,
    width = 1.5,
    height = 2.15,
    resolution = Number.POSITIVE_INFINITY,
    samples = 2,
    frame = new MeshStandardMaterial({ color: 0x2a2f38, roughness: 0.35, metalness: 0.7 }),
  }: MirrorOptions = {}) {
    this.frame = new Mesh<BufferGeometry, MeshStandardMaterial>(undefined, frame);
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

  /**
   * Moves the mirror's centre to (x, z) [m], floor frame. `turned`: its heading [rad], 0 facing +Z, positive towards
   * +X.
   */
  place(x: number, z: number, turned: number): void {
    this.object.position.set(x, this.object.position.y, z);
    this.object.rotation.y = turned;
  }

  /** Sets the maximum rate of reflections in a session [Hz]; null: one in each frame. */
  setMaxRate(rateHz: number | null): void {
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
      renderer.getDrawingBufferSize(pictureSize);
      this.fitTarget(0, pictureSize.x, pictureSize.y);
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
      this.fitTarget(eye, wide, high);
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

  /** Sets the size of a reflector's texture for a picture of this size [pixels]: it shows the picture's own view. */
  private fitTarget(index: number, wide: number, high: number): void {
    const share = Math.min(1, this.resolution / wide);
    const width = Math.floor(wide * share);
    const height = Math.floor(high * share);
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

  /** Draws the reflection for a camera if it sees the reflector, and no more of it than it sees. */
  private reflectTo(index: number, renderer: WebGLRenderer, scene: Scene, camera: Camera): void {
    const glass = this.glasses[index]!;
    glass.visible = true;
    glass.updateWorldMatrix(true, false);
    const seen = seenPart(camera, glass.matrixWorld, this.width, this.height);
    if (!seen) return;
    const target = glass.getRenderTarget();
    limitToPart(target, seen);
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
    // All renders of a frame have one frame number: bones are uploaded for the first only.
    render.frame = frame;
    this.object.visible = true;
  }

  private addGlass(): void {
    const glass = new Reflector(new PlaneGeometry(this.width, this.height), {
      clipBias: 0.003,
      multisample: this.samples,
      // The glass absorbs a little light; #bcbcbc would absorb none.
      color: 0xb6b9bb,
      shader,
    });
    const target = glass.getRenderTarget();
    // The reflection is tone-mapped already.
    (glass.material as Material).toneMapped = false;
    // By this property three.js encodes the colours of a render target like those of the canvas, which needs no more
    // bits.
    Object.assign(target, { isXRRenderTarget: true });
    target.texture.type = UnsignedByteType;
    // The shaders encode the colours, hence no sRGB format, which would encode them again. Multisampled and resolved
    // pixels must have one format.
    target.texture.internalFormat = 'RGBA8';
    // In first person the head is on this layer alone, and the mirror shows it. Objects on the layers of the eyes are
    // not shown. The reflecting camera is a copy made by a method that three.js's types leave out.
    const cameras = glass as unknown as { getReflectionCamera(camera: Camera): Camera };
    const makeCamera = cameras.getReflectionCamera;
    cameras.getReflectionCamera = (camera) => {
      const reflecting = makeCamera.call(glass, camera);
      reflecting.layers.enable(thirdPersonOnlyLayer);
      for (const eye of eyeLayers) reflecting.layers.disable(eye);
      return reflecting;
    };
    this.reflections.push(glass.onBeforeRender);
    // The reflection is drawn before the scene: a nested render has another light state, for which every material would
    // be looked up again.
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

/** The tolerance for frames that come a little early [s]. */
const toleranceSeconds = 0.001;

/** Selects the frames for work that runs at a lower rate than frames. */
export class FramePacer {
  /** The maximum rate [Hz]; null: every frame. */
  rateHz: number | null = null;
  #next = Number.NEGATIVE_INFINITY;

  restart(): void {
    this.#next = Number.NEGATIVE_INFINITY;
  }

  /** Returns whether the work is due in the frame at this time [s]. Call it once per frame. */
  isDue(time: number): boolean {
    if (this.rateHz === null) return true;
    const interval = 1 / this.rateHz;
    const wait = this.#next - time;
    // A wait longer than an interval shows that the clock was set back.
    if (wait > toleranceSeconds && wait <= interval) return false;
    this.#next = wait > -interval && wait <= toleranceSeconds ? this.#next + interval : time + interval;
    return true;
  }
}

/** The size of a picture [pixels], overwritten by each reflection. */
const pictureSize = new Vector2();

/** A part of a picture, from −1 to 1, right and up. */
interface PicturePart {
  left: number;
  right: number;
  bottom: number;
  top: number;
}

const wholePicture: Readonly<PicturePart> = { left: -1, right: 1, bottom: -1, top: 1 };
/** The result of the newest call, reused to avoid garbage. */
const part: PicturePart = { ...wholePicture };
/** A corner this near to the camera's plane has no place in the picture [m]. */
const nearestCorner = 0.01;

const clipFromRectangle = new Matrix4();

/**
 * Returns the part of the picture of a camera that a rectangle [m] about the origin of its frame's xy plane may cover;
 * null: all corners lie beyond one plane of the view frustum. Allocates nothing: the next call overwrites the result.
 * The camera's matrices must be up to date.
 */
export function seenPart(
  camera: Camera,
  floorFromRectangle: Matrix4,
  width: number,
  height: number,
): Readonly<PicturePart> | null {
  clipFromRectangle.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(floorFromRectangle);
  const m = clipFromRectangle.elements;
  for (let axis = 0; axis < 3; axis++) {
    for (let side = -1; side <= 1; side += 2) {
      // A point is inside a plane if |clip coordinate| ≤ w: the corner farthest inside decides.
      const x = m[3]! + side * m[axis]!;
      const y = m[7]! + side * m[axis + 4]!;
      const middle = m[15]! + side * m[axis + 12]!;
      if (middle + (Math.abs(x) * width + Math.abs(y) * height) / 2 < 0) return null;
    }
  }
  part.left = part.bottom = 1;
  part.right = part.top = -1;
  for (let x = -width / 2; x <= width / 2; x += width) {
    for (let y = -height / 2; y <= height / 2; y += height) {
      const depth = m[3]! * x + m[7]! * y + m[15]!;
      if (depth < nearestCorner) return wholePicture;
      const across = (m[0]! * x + m[4]! * y + m[12]!) / depth;
      const up = (m[1]! * x + m[5]! * y + m[13]!) / depth;
      part.left = Math.max(-1, Math.min(part.left, across));
      part.right = Math.min(1, Math.max(part.right, across));
      part.bottom = Math.max(-1, Math.min(part.bottom, up));
      part.top = Math.min(1, Math.max(part.top, up));
    }
  }
  return part;
}

/** Draws a target only where the picture shows it; a reflection has left and right exchanged. */
function limitToPart(target: WebGLRenderTarget, { left, right, bottom, top }: Readonly<PicturePart>): void {
  const { width, height } = target;
  // Sampling takes in a pixel beyond each edge.
  const [x, y] = [Math.floor(((1 - right) / 2) * width) - 1, Math.floor(((1 + bottom) / 2) * height) - 1];
  target.scissorTest = true;
  target.scissor.set(x, y, Math.ceil(((right - left) / 2) * width) + 3, Math.ceil(((top - bottom) / 2) * height) + 3);
}
