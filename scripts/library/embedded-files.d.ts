declare module '*.bin' {
  const bytes: Uint8Array<ArrayBuffer>;
  export default bytes;
}
declare module '*.vrm' {
  const bytes: Uint8Array<ArrayBuffer>;
  export default bytes;
}
declare module '*?bundled' {
  const code: string;
  export default code;
}
