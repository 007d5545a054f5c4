/** White around the code, without which cameras do not find it [modules]. */
const quiet = 4;

/** A text as a QR code, with the white around it. */
export interface QrCode {
  /** The side of the square, including the white margin on both sides [modules]. */
  readonly side: number;
  /** Whether a module is dark, by column and row from the upper left. */
  readonly isDark: (x: number, y: number) => boolean;
}

/** The QR code of a text. The encoder is loaded when the first one is made; rejects where it cannot be. */
export async function qrCode(text: string): Promise<QrCode> {
  const { encode } = await import('uqr');
  const { data, size } = encode(text, { ecc: 'M', border: quiet });
  return { side: size, isDark: (x, y) => data[y]?.[x] ?? false };
}

/**
 * On a canvas, black on white, in the middle of this square [pixels]. Each module is a whole number of pixels wide: the
 * code is as large as that lets it be.
 */
export function drawQrCode(
  context: CanvasRenderingContext2D,
  { side, isDark }: QrCode,
  [left, top, width]: readonly [number, number, number],
): void {
  const module = Math.floor(width / side);
  const free = Math.floor((width - module * side) / 2);
  context.fillStyle = '#fff';
  context.fillRect(left, top, width, width);
  context.fillStyle = '#000';
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      if (isDark(x, y)) context.fillRect(left + free + x * module, top + free + y * module, module, module);
    }
  }
}
