/**
 * The largest size of a reflection relative to the image that shows it [fraction of pixels]. A mirror of 1.5 × 2.15 m
 * seen from 1.5 m fills less than a third of an eye's 96°.
 */
const pixelShare = 0.4;

/** The size of a texture [pixels]. */
export interface TextureSize {
  readonly width: number;
  readonly height: number;
}

/** The result of the newest call, reused to avoid garbage. */
const size = { width: 0, height: 0 };

/**
 * Returns the size of the reflection in an image of this many pixels. `heightToWidth`: the aspect of the mirror;
 * `maxWidth`: the limit [pixels]. The next call overwrites the result.
 */
export function reflectionSize(pixels: number, heightToWidth: number, maxWidth: number): TextureSize {
  const width = Math.floor(Math.min(maxWidth, Math.sqrt((pixelShare * pixels) / heightToWidth)));
  size.width = width;
  size.height = Math.floor(width * heightToWidth);
  return size;
}
