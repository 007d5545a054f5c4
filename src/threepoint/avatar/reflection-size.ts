/**
 * A reflection has at most this share of the pixels of the picture that it is part of. A mirror of 1.5 × 2.15 m seen
 * from 1.5 m fills less than a third of an eye of 96°.
 */
const pixelShare = 0.4;

/** The size of a texture [pixels]. */
export interface TextureSize {
  readonly width: number;
  readonly height: number;
}

/** The sizes of the newest calls, so that a frame makes no garbage. */
const size = { width: 0, height: 0 };

/**
 * Returns the size of the reflection in a picture of this many pixels, for a glass of this height to width, at most so
 * wide [pixels]. The next call overwrites it.
 */
export function reflectionSize(pixels: number, heightToWidth: number, mostWidth: number): TextureSize {
  const width = Math.floor(Math.min(mostWidth, Math.sqrt((pixelShare * pixels) / heightToWidth)));
  size.width = width;
  size.height = Math.floor(width * heightToWidth);
  return size;
}
