import { clamp } from 'threepoint/math';
import { createRandomRange } from '../random-range';

/** Sounds as samples in [−1, 1], made here; rate in samples per second. The same arguments make the same sound. */
export type Samples = Float32Array<ArrayBuffer>;

/** A whole turn [rad]. */
export const tau = 2 * Math.PI;

/** Renders samples one by one. */
export function render(rate: number, seconds: number, sample: (t: number, index: number) => number): Samples {
  const samples = new Float32Array(Math.ceil(rate * seconds));
  for (let i = 0; i < samples.length; i++) samples[i] = sample(i / rate, i);
  return samples;
}

/** Normalises to a peak, and fades out the last 10 ms, so that the sound ends without a click. */
export function normalised(samples: Samples, rate: number, peak: number): Samples {
  let highest = 0;
  for (const value of samples) highest = Math.max(highest, Math.abs(value));
  const factor = highest > 0 ? peak / highest : 0;
  const fade = Math.min(samples.length, Math.ceil(rate / 100));
  for (let i = 0; i < samples.length; i++) {
    samples[i] = (samples[i] as number) * factor * Math.min(1, (samples.length - 1 - i) / fade);
  }
  return samples;
}

/** White noise in [−1, 1], the same for the same seed. */
export const noiseFrom = (seed: number) => {
  const random = createRandomRange(seed);
  return () => random(-1, 1);
};

/** Creates a low-pass filter with this cutoff `frequency` [Hz]. */
export function lowPass(rate: number, frequency: number): (value: number) => number {
  const share = 1 - Math.exp((-tau * frequency) / rate);
  let held = 0;
  return (value) => {
    held += share * (value - held);
    return held;
  };
}

/** Creates a resonator at `frequency` [Hz]; a smaller bandwidth [Hz] rings longer. */
export function resonator(rate: number, frequency: number, bandwidth: number): (value: number) => number {
  const radius = Math.exp((-Math.PI * bandwidth) / rate);
  const a = 2 * radius * Math.cos((tau * frequency) / rate);
  const b = -radius * radius;
  let first = 0;
  let second = 0;
  return (value) => {
    const next = (1 - radius) * value + a * first + b * second;
    second = first;
    first = next;
    return next;
  };
}

/** Air round something that flies. */
export function whoosh(rate: number): Samples {
  const noise = noiseFrom(307);
  const high = lowPass(rate, 2600);
  const low = lowPass(rate, 500);
  const seconds = 0.7;
  const samples = render(rate, seconds, (t) => {
    const value = high(noise());
    return (value - low(value)) * Math.sin((Math.PI * t) / seconds) ** 1.4;
  });
  return normalised(samples, rate, 0.3);
}

/** A struck bar: partials of a bar that is free at both ends. */
function bar(t: number, frequency: number, seconds: number): number {
  return (
    Math.sin(tau * frequency * t) * Math.exp(-t / seconds) +
    0.42 * Math.sin(tau * frequency * 2.756 * t) * Math.exp((-2.4 * t) / seconds) +
    0.16 * Math.sin(tau * frequency * 5.404 * t) * Math.exp((-5 * t) / seconds)
  );
}

/** Notes [Hz] of a score, from the least target to the best. */
const scale = [523.25, 659.26, 783.99, 1046.5] as const;

/** Points: the more, the higher, with a grace note before. */
export function chime(rate: number, points: number): Samples {
  const step = clamp(Math.round(points / 5) - 1, 0, scale.length - 1);
  const note = scale[step] as number;
  const attack = (t: number) => 1 - Math.exp(-t / 0.002);
  const samples = render(rate, 1.1, (t) => {
    const second = t - 0.09;
    return 0.55 * bar(t, note * 0.75, 0.22) * attack(t) + (second > 0 ? bar(second, note, 0.42) * attack(second) : 0);
  });
  return normalised(samples, rate, 0.5);
}

export function bell(rate: number): Samples {
  const partials = [
    [0.5, 0.5, 1.3],
    [1, 1, 0.9],
    [1.19, 0.7, 0.7],
    [1.5, 0.45, 0.5],
    [2, 0.6, 0.45],
    [2.67, 0.25, 0.3],
    [4.1, 0.14, 0.18],
  ] as const;
  const samples = render(
    rate,
    2.6,
    (t) =>
      partials.reduce(
        (sum, [ratio, loud, seconds]) => sum + loud * Math.sin(tau * 466 * ratio * t) * Math.exp(-t / seconds),
        0,
      ) *
      (1 - Math.exp(-t / 0.0015)),
  );
  return normalised(samples, rate, 0.6);
}

/** Something snaps into place: a nock onto its string, a ball into a hand. */
export function click(rate: number): Samples {
  const noise = noiseFrom(701);
  const wood = resonator(rate, 1650, 240);
  const samples = render(rate, 0.07, (t) => wood(noise() * Math.exp(-t / 0.003)));
  return normalised(samples, rate, 0.35);
}

/** Two low notes that go down: something is not as it should be. */
export function warning(rate: number): Samples {
  const samples = render(rate, 0.42, (t) => {
    const second = t - 0.18;
    return (
      Math.sin(tau * 392 * t) * Math.exp(-t / 0.08) * (1 - Math.exp(-t / 0.004)) +
      (second > 0 ? Math.sin(tau * 311 * second) * Math.exp(-second / 0.1) * (1 - Math.exp(-second / 0.004)) : 0)
    );
  });
  return normalised(samples, rate, 0.35);
}
