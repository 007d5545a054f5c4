import {
  ACESFilmicToneMapping,
  LinearMipmapLinearFilter,
  LinearMipmapNearestFilter,
  type MinificationTextureFilter,
  PCFShadowMap,
  PerspectiveCamera,
  SRGBColorSpace,
  WebGLRenderer,
} from 'three';

/** high: antialiasing, shadow map, device pixels. low: for software rendering; blob shadows, fewer pixels. */
export type Quality = 'high' | 'low';

/**
 * How finely a texture seen at a glancing angle is sampled: each sample costs as much as a pixel where software draws.
 */
export const anisotropyOf = (quality: Quality): number => (quality === 'high' ? 8 : 1);

/** How a texture seen from afar is sampled: between two of its sizes, or from the nearer one at half the cost. */
export const minFilterOf = (quality: Quality): MinificationTextureFilter =>
  quality === 'high' ? LinearMipmapLinearFilter : LinearMipmapNearestFilter;

/** Whether this browser draws in software, where a headset's picture quality costs a second per frame. */
function drawsInSoftware(context: WebGLRenderingContext | WebGL2RenderingContext): boolean {
  const debug = context.getExtension('WEBGL_debug_renderer_info');
  const name = debug ? String(context.getParameter(debug.UNMASKED_RENDERER_WEBGL)) : '';
  return /swiftshader|llvmpipe|software/i.test(name);
}

/** Returns the quality that this machine can afford. Throws without WebGL 2. */
export function affordableQuality(): Quality {
  const context = document.createElement('canvas').getContext('webgl2');
  if (!context)
    throw new Error('This browser does not support WebGL 2. Turn on hardware acceleration or use another browser.');
  const software = drawsInSoftware(context);
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return software ? 'low' : 'high';
}

/** Creates the renderer of canvas and headset. Throws if WebGL 2 is unavailable. */
export function createRenderer(canvas: HTMLCanvasElement, quality: Quality): WebGLRenderer {
  const renderer = new WebGLRenderer({ canvas, antialias: quality === 'high', powerPreference: 'high-performance' });
  renderer.outputColorSpace = SRGBColorSpace;
  // Light through a window is several times as bright as the room. Sky, hills and fog are not mapped.
  renderer.toneMapping = ACESFilmicToneMapping;
  renderer.shadowMap.enabled = quality === 'high';
  renderer.shadowMap.type = PCFShadowMap;
  renderer.xr.enabled = true;
  renderer.xr.setReferenceSpaceType('local-floor');
  return renderer;
}

/** Share of the window's pixels, in each direction, that are drawn in low quality. */
const lowPixelRatio = 0.66;

/**
 * An emulated headset draws into the whole window, however large that is: in low quality it gets fewer pixels. Call it
 * in a session.
 */
export function reduceEmulatedResolution(renderer: WebGLRenderer, quality: Quality): void {
  if (quality === 'high') return;
  const { domElement } = renderer;
  domElement.width = Math.round(window.innerWidth * lowPixelRatio);
  domElement.height = Math.round(window.innerHeight * lowPixelRatio);
}

/** Fits the drawing buffer to the window; a headset's own buffer is none of its business. */
export function fitToWindow(renderer: WebGLRenderer, quality: Quality): void {
  if (renderer.xr.isPresenting) return;
  const pixelRatio = quality === 'high' ? Math.min(window.devicePixelRatio, 2) : lowPixelRatio;
  renderer.setDrawingBufferSize(window.innerWidth, window.innerHeight, pixelRatio);
}

/** Creates the camera of a session. The headset places it; this sets its near and far planes only. */
export const createHeadsetCamera = (): PerspectiveCamera => new PerspectiveCamera(70, 1, 0.05, 90);
