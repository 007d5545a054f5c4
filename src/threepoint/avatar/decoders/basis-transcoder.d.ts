/** The Basis transcoder as emscripten wraps it: three.js's worker alone calls it. */
declare module 'three/examples/jsm/libs/basis/basis_transcoder.js' {
  const makeBasis: (options: object) => Promise<unknown>;
  export default makeBasis;
}
