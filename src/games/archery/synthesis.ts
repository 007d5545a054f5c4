import { clamp } from '../../core/math/damper';
import { createScatter } from './scatter';

/** Sounds as samples in [−1, 1], made here; rate in samples per second. The same arguments make the same sound. */
type Samples = Float32Array<ArrayBuffer>;

const tau = 2 * Math.PI;

function render(rate: number, seconds: number, sample: (t: number, index: number) => number): Samples {
  const samples = new Float32Array(Math.ceil(rate * seconds));
  for (let i = 0; i < samples.length; i++) samples[i] = sample(i / rate, i);
  return samples;
}

/** Scales to a peak, and lets the last hundredth of a second fade, so that nothing clicks at its end. */
function finished(samples: Samples, rate: number, peak: number): Samples {
  let highest = 0;
  for (const value of samples) highest = Math.max(highest, Math.abs(value));
  const factor = highest > 0 ? peak / highest : 0;
  const fade = Math.min(samples.length, Math.ceil(rate / 100));
  for (let i = 0; i < samples.length; i++) {
    samples[i] = (samples[i] as number) * factor * Math.min(1, (samples.length - 1 - i) / fade);
  }
  return samples;
}

const noiseFrom = (seed: number) => {
  const random = createScatter(seed);
  return () => random(-1, 1);
};

/** Lets through what is slower than `frequency` [Hz]. */
function lowPass(rate: number, frequency: number): (value: number) => number {
  const share = 1 - Math.exp((-tau * frequency) / rate);
  let held = 0;
  return (value) => {
    held += share * (value - held);
    return held;
  };
}

/** Rings at `frequency` [Hz], the more the smaller its bandwidth [Hz]. */
function resonator(rate: number, frequency: number, bandwidth: number): (value: number) => number {
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

/** Wood under strain: stick and slip, higher, denser and louder the further it is drawn; draw as a share of the most, in [0, 1]. */
export function creak(rate: number, draw: number): Samples {
  const strain = clamp(draw, 0, 1);
  const noise = noiseFrom(101 + Math.round(strain * 16));
  const body = [resonator(rate, 240 + 130 * strain, 60), resonator(rate, 610 + 260 * strain, 90)] as const;
  let untilSlip = 0;
  const samples = render(rate, 0.16, (t) => {
    untilSlip -= 1;
    let push = 0;
    if (untilSlip <= 0) {
      push = 0.6 + 0.4 * noise();
      untilSlip = (rate / (46 + 60 * strain)) * (1 + 0.35 * noise());
    }
    const swell = Math.sin(Math.PI * Math.min(1, t / 0.16)) ** 0.8;
    return (body[0](push) + 0.7 * body[1](push) + 0.002 * noise()) * swell;
  });
  return finished(samples, rate, 0.12 + 0.3 * strain);
}

/** The string lets go: a plucked string that dies fast, and the slap of the limbs. */
export function twang(rate: number, draw: number): Samples {
  const strength = clamp(draw, 0, 1);
  const noise = noiseFrom(211);
  const period = Math.round(rate / (88 + 34 * strength));
  const string = new Float32Array(period).map(noise);
  const slap = lowPass(rate, 1400);
  let at = 0;
  const samples = render(rate, 0.5, (t) => {
    const now = string[at] as number;
    const next = string[(at + 1) % period] as number;
    string[at] = 0.987 * (0.5 * now + 0.5 * next);
    at = (at + 1) % period;
    return now * Math.exp(-t / 0.12) + 1.6 * slap(noise()) * Math.exp(-t / 0.012);
  });
  return finished(samples, rate, 0.45 + 0.4 * strength);
}

/** Air round an arrow. */
export function whoosh(rate: number): Samples {
  const noise = noiseFrom(307);
  const high = lowPass(rate, 2600);
  const low = lowPass(rate, 500);
  const seconds = 0.7;
  const samples = render(rate, seconds, (t) => {
    const value = high(noise());
    return (value - low(value)) * Math.sin((Math.PI * t) / seconds) ** 1.4;
  });
  return finished(samples, rate, 0.3);
}

/** An arrow goes into straw: a dull blow with a crackle. */
export function thud(rate: number): Samples {
  const noise = noiseFrom(401);
  const straw = lowPass(rate, 2200);
  const samples = render(rate, 0.35, (t) => {
    const blow = Math.sin(tau * (78 * t + 2.1 * (1 - Math.exp(-t / 0.03)))) * Math.exp(-t / 0.07);
    return blow + 0.75 * straw(noise()) * Math.exp(-t / 0.022);
  });
  return finished(samples, rate, 0.85);
}

/** An arrow goes into the ground: lower, softer, grass about it. */
export function earth(rate: number): Samples {
  const noise = noiseFrom(503);
  const grass = lowPass(rate, 900);
  const samples = render(rate, 0.3, (t) => {
    const blow = Math.sin(tau * (52 * t + 1.1 * (1 - Math.exp(-t / 0.03)))) * Math.exp(-t / 0.05);
    return 0.8 * blow + 1.1 * grass(noise()) * Math.exp(-t / 0.05);
  });
  return finished(samples, rate, 0.55);
}

/** An arrow is caught by a net: cords rattle. */
export function rattle(rate: number): Samples {
  const noise = noiseFrom(601);
  const low = lowPass(rate, 700);
  const samples = render(rate, 0.45, (t) => {
    const value = noise();
    return (value - low(value)) * Math.exp(-t / 0.11) * (0.35 + 0.65 * Math.max(0, Math.sin(tau * 31 * t)));
  });
  return finished(samples, rate, 0.3);
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
  return finished(samples, rate, 0.5);
}

/** The bell at the end of a round. */
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
  return finished(samples, rate, 0.6);
}

/** The nock snaps onto the string, or the bow into the hand. */
export function click(rate: number): Samples {
  const noise = noiseFrom(701);
  const wood = resonator(rate, 1650, 240);
  const samples = render(rate, 0.07, (t) => wood(noise() * Math.exp(-t / 0.003)));
  return finished(samples, rate, 0.35);
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
  return finished(samples, rate, 0.35);
}
