import { writeFileSync } from 'node:fs';

/** The sample rate of the file [Hz]. */
const rate = 48_000;
const seconds = 4;

/**
 * Writes a WAV file of a voice-like sound: five harmonics that swell and fade four times a second, as syllables do.
 * Noise suppression would remove a steady tone. The file can be played in a loop without a click.
 */
export function writeFakeVoice(path: string): void {
  const count = rate * seconds;
  const bytes = Buffer.alloc(44 + 2 * count);
  bytes.write('RIFF', 0);
  bytes.writeUInt32LE(36 + 2 * count, 4);
  bytes.write('WAVEfmt ', 8);
  bytes.writeUInt32LE(16, 16);
  bytes.writeUInt16LE(1, 20);
  bytes.writeUInt16LE(1, 22);
  bytes.writeUInt32LE(rate, 24);
  bytes.writeUInt32LE(2 * rate, 28);
  bytes.writeUInt16LE(2, 32);
  bytes.writeUInt16LE(16, 34);
  bytes.write('data', 36);
  bytes.writeUInt32LE(2 * count, 40);
  for (let i = 0; i < count; i++) {
    const t = i / rate;
    const swell = Math.sin(Math.PI * 4 * t) ** 2;
    let sound = 0;
    for (let harmonic = 1; harmonic <= 5; harmonic++) sound += Math.sin(2 * Math.PI * 175 * harmonic * t) / harmonic;
    bytes.writeInt16LE(Math.round(9000 * swell * sound), 44 + 2 * i);
  }
  writeFileSync(path, bytes);
}
