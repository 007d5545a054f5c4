/** The part of Draco's decoder, as Emscripten wraps it, that this project calls. Pointers are numbers. */
declare module 'three/addons/libs/draco/gltf/draco_wasm_wrapper.js' {
  interface Attribute {
    num_components(): number;
  }
  interface Mesh {
    readonly ptr: number;
    num_points(): number;
    num_faces(): number;
  }
  interface Decoder {
    DecodeArrayToMesh(packed: Int8Array, length: number, mesh: Mesh): { ok(): boolean; error_msg(): string };
    GetTrianglesUInt32Array(mesh: Mesh, bytes: number, at: number): boolean;
    GetAttributeByUniqueId(mesh: Mesh, id: number): Attribute;
    GetAttributeDataArrayForAllPoints(
      mesh: Mesh,
      attribute: Attribute,
      type: number,
      bytes: number,
      at: number,
    ): boolean;
  }
  interface Draco {
    readonly Decoder: new () => Decoder;
    readonly Mesh: new () => Mesh;
    readonly HEAPF32: { readonly buffer: ArrayBuffer };
    readonly DT_FLOAT32: number;
    readonly DT_INT8: number;
    readonly DT_INT16: number;
    readonly DT_UINT8: number;
    readonly DT_UINT16: number;
    readonly DT_UINT32: number;
    _malloc(bytes: number): number;
    _free(at: number): void;
    destroy(object: Mesh | Decoder): void;
  }
  const makeDraco: (options: { readonly wasmBinary: ArrayBuffer }) => Promise<Draco>;
  export default makeDraco;
}
