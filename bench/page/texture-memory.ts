/** The size of a texel of this internal format of WebGL 2 [bytes]. */
function texelBytes(gl: WebGL2RenderingContext, format: number): number {
  switch (format) {
    case gl.R8:
      return 1;
    case gl.RG8:
    case gl.R16F:
    case gl.DEPTH_COMPONENT16:
      return 2;
    case gl.RGBA16F:
    case gl.RG32F:
      return 8;
    case gl.RGBA32F:
      return 16;
    default:
      return 4;
  }
}

/** The bytes of one image with all of its smaller copies, where it has them. */
function imageBytes(width: number, height: number, texel: number, levels: number): number {
  let bytes = 0;
  for (let level = 0; level < levels; level++) bytes += Math.max(1, width >> level) * Math.max(1, height >> level);
  return bytes * texel;
}

/** What textures and the buffers of render targets take on the graphics device, without the picture itself. */
export class TextureMemory {
  readonly #bytes = new Map<object, number>();

  /** Counts from now on what this context allocates. Call it before the first texture. */
  constructor(gl: WebGL2RenderingContext) {
    this.#countTextures(gl);
    this.#countRenderbuffers(gl);
  }

  get megabytes(): number {
    return [...this.#bytes.values()].reduce((sum, each) => sum + each, 0) / 1e6;
  }

  #countTextures(gl: WebGL2RenderingContext): void {
    const bindings = new Map<number, number>([
      [gl.TEXTURE_2D, gl.TEXTURE_BINDING_2D],
      [gl.TEXTURE_CUBE_MAP, gl.TEXTURE_BINDING_CUBE_MAP],
      [gl.TEXTURE_3D, gl.TEXTURE_BINDING_3D],
      [gl.TEXTURE_2D_ARRAY, gl.TEXTURE_BINDING_2D_ARRAY],
    ]);
    const bound = (target: number): object | null => {
      const binding = bindings.get(target);
      return binding === undefined ? null : (gl.getParameter(binding) as object | null);
    };
    const { texStorage2D, texStorage3D, texImage2D, deleteTexture } = gl;
    gl.texStorage2D = (target, levels, format, width, height) => {
      texStorage2D.call(gl, target, levels, format, width, height);
      const texture = bound(target);
      const faces = target === gl.TEXTURE_CUBE_MAP ? 6 : 1;
      if (texture) this.#bytes.set(texture, faces * imageBytes(width, height, texelBytes(gl, format), levels));
    };
    gl.texStorage3D = (target, levels, format, width, height, depth) => {
      texStorage3D.call(gl, target, levels, format, width, height, depth);
      const texture = bound(target);
      if (texture) this.#bytes.set(texture, depth * imageBytes(width, height, texelBytes(gl, format), levels));
    };
    Object.assign(gl, {
      texImage2D: (...given: Parameters<WebGL2RenderingContext['texImage2D']>) => {
        texImage2D.apply(gl, given);
        const [target, level, format, width, height] = given as unknown as readonly number[];
        const texture = bound(target ?? 0);
        // The other forms of the call take an image, which three.js passes to textures without storage alone.
        if (texture && level === 0 && (given as readonly unknown[]).length === 9)
          this.#bytes.set(texture, imageBytes(width ?? 0, height ?? 0, texelBytes(gl, format ?? 0), 1));
      },
    });
    gl.deleteTexture = (texture) => {
      deleteTexture.call(gl, texture);
      if (texture) this.#bytes.delete(texture);
    };
  }

  #countRenderbuffers(gl: WebGL2RenderingContext): void {
    const count = (format: number, width: number, height: number, samples: number): void => {
      const buffer = gl.getParameter(gl.RENDERBUFFER_BINDING) as object | null;
      if (buffer) this.#bytes.set(buffer, width * height * texelBytes(gl, format) * Math.max(1, samples));
    };
    const { renderbufferStorage, renderbufferStorageMultisample, deleteRenderbuffer } = gl;
    gl.renderbufferStorage = (target, format, width, height) => {
      renderbufferStorage.call(gl, target, format, width, height);
      count(format, width, height, 1);
    };
    gl.renderbufferStorageMultisample = (target, samples, format, width, height) => {
      renderbufferStorageMultisample.call(gl, target, samples, format, width, height);
      count(format, width, height, samples);
    };
    gl.deleteRenderbuffer = (buffer) => {
      deleteRenderbuffer.call(gl, buffer);
      if (buffer) this.#bytes.delete(buffer);
    };
  }
}
