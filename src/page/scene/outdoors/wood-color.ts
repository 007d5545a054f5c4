import { Color } from 'three';

const tones = ['#8a6748', '#94714f', '#7d5c40', '#9c7a57'] as const;

/** The colour of a piece of wood; different pieces differ a little, the same seed is the same piece. */
export function woodColor(seed: number): string {
  const at = Math.abs(Math.round(seed * 7.3)) % tones.length;
  return `#${new Color(tones[at]).getHexString()}`;
}
