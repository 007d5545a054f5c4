import { describe, expect, it } from 'vitest';
import { creak, earth, rattle, thud, twang } from '../../../src/page/archery/sound/archery-synthesis';
import { bell, chime, click, warning, whoosh } from '../../../src/page/scene/sound/sound-synthesis';

const rate = 48000;
const sounds = {
  bell: bell(rate),
  chime: chime(rate, 20),
  click: click(rate),
  creak: creak(rate, 0.5),
  earth: earth(rate),
  rattle: rattle(rate),
  thud: thud(rate),
  twang: twang(rate, 1),
  warning: warning(rate),
  whoosh: whoosh(rate),
};

const peak = (samples: Float32Array) => samples.reduce((most, value) => Math.max(most, Math.abs(value)), 0);

/** Share of the energy that lies in neighbouring samples' differences: more for brighter sounds. */
const brightness = (samples: Float32Array) => {
  let change = 0;
  let energy = 0;
  for (let i = 1; i < samples.length; i++) {
    change += ((samples[i] as number) - (samples[i - 1] as number)) ** 2;
    energy += (samples[i] as number) ** 2;
  }
  return change / energy;
};

/** How often a sound crosses zero upwards in a second, from `start` [s] on. */
const pitch = (samples: Float32Array, start: number) => {
  const from = Math.floor(start * rate);
  let crossings = 0;
  for (let i = from + 1; i < samples.length; i++) {
    if ((samples[i - 1] as number) < 0 && (samples[i] as number) >= 0) crossings += 1;
  }
  return (crossings * rate) / (samples.length - from);
};

describe('every sound', () => {
  it('is loud enough to hear, never clips, and ends in silence', () => {
    for (const [name, samples] of Object.entries(sounds)) {
      expect(samples.every(Number.isFinite), name).toBe(true);
      expect(peak(samples), name).toBeLessThanOrEqual(0.95);
      expect(peak(samples), name).toBeGreaterThan(0.1);
      expect(Math.abs(samples.at(-1) as number), name).toBeLessThan(1e-3);
    }
  });

  it('is over within three seconds', () => {
    for (const [name, samples] of Object.entries(sounds)) expect(samples.length / rate, name).toBeLessThan(3);
  });

  it('is the same each time', () => {
    expect(thud(rate)).toEqual(sounds.thud);
    expect(creak(rate, 0.5)).toEqual(sounds.creak);
  });
});

describe('sounds that differ by ear', () => {
  it('a draw creaks louder the further the bow is drawn', () => {
    const loudness = [0, 0.25, 0.5, 0.75, 1].map((draw) => peak(creak(rate, draw)));
    expect(loudness).toEqual([...loudness].sort((a, b) => a - b));
  });

  it('more points ring higher', () => {
    const heights = [5, 10, 15, 20].map((points) => pitch(chime(rate, points), 0.5));
    expect(heights).toEqual([...heights].sort((a, b) => a - b));
    expect((heights[3] as number) / (heights[0] as number)).toBeCloseTo(2, 1);
  });

  it('a hit net is brighter than hit straw', () => {
    expect(brightness(sounds.rattle)).toBeGreaterThan(10 * brightness(sounds.thud));
  });
});
