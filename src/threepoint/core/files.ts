/** Returns what sentences call an address: its last part. */
export const nameOfAddress = (url: string): string => url.split(/[?#]/)[0]?.split('/').at(-1) || url;

/** Returns the pieces of a file as one. */
export function joinBytes(pieces: readonly Uint8Array[]): Uint8Array<ArrayBuffer> {
  const whole = new Uint8Array(pieces.reduce((sum, { length }) => sum + length, 0));
  let offset = 0;
  for (const piece of pieces) {
    whole.set(piece, offset);
    offset += piece.length;
  }
  return whole;
}
