/** Width and height of a picture [pixels]. */
interface ImageSize {
  readonly width: number;
  readonly height: number;
}

const hasAscii = (bytes: Uint8Array, at: number, text: string): boolean =>
  [...text].every((letter, i) => bytes[at + i] === letter.charCodeAt(0));

export const isKtx2 = (bytes: Uint8Array): boolean => hasAscii(bytes, 1, 'KTX 20');

/** Returns the size of a PNG, JPEG, WebP or KTX2 file by its header; null: it is none of them. */
export function imageSize(bytes: Uint8Array): ImageSize | null {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  try {
    if (hasAscii(bytes, 1, 'PNG')) return { width: view.getUint32(16), height: view.getUint32(20) };
    if (hasAscii(bytes, 0, 'RIFF') && hasAscii(bytes, 8, 'WEBP')) return webpSize(bytes, view);
    if (isKtx2(bytes)) return { width: view.getUint32(20, true), height: view.getUint32(24, true) };
    if (view.getUint16(0) === 0xffd8) return jpegSize(view);
  } catch (error) {
    // Truncated: no image.
    if (!(error instanceof RangeError)) throw error;
  }
  return null;
}

function webpSize(bytes: Uint8Array, view: DataView): ImageSize | null {
  if (hasAscii(bytes, 12, 'VP8X')) {
    const three = (at: number) => view.getUint16(at, true) + 65536 * view.getUint8(at + 2);
    return { width: 1 + three(24), height: 1 + three(27) };
  }
  if (hasAscii(bytes, 12, 'VP8L')) {
    const packed = view.getUint32(21, true);
    return { width: 1 + (packed & 0x3fff), height: 1 + ((packed >>> 14) & 0x3fff) };
  }
  if (hasAscii(bytes, 12, 'VP8 '))
    return { width: view.getUint16(26, true) & 0x3fff, height: view.getUint16(28, true) & 0x3fff };
  return null;
}

/** Returns the size in the frame header, which follows any number of other segments. */
function jpegSize(view: DataView): ImageSize | null {
  let at = 2;
  while (view.getUint8(at) === 0xff) {
    const marker = view.getUint8(at + 1);
    // C0 to CF start a frame, except the tables C4 and CC and the reserved C8.
    if (marker >= 0xc0 && marker <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(marker))
      return { width: view.getUint16(at + 7), height: view.getUint16(at + 5) };
    at += 2 + view.getUint16(at + 2);
  }
  return null;
}
