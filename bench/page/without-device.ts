/**
 * Draw calls reach no device from now on: in software drawing would be most of a frame, and the page's thread would
 * wait for it.
 */
export function withoutDevice(gl: WebGLRenderingContext | WebGL2RenderingContext): void {
  for (const name of ['clear', 'drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced'])
    Object.assign(gl, { [name]: () => undefined });
}
