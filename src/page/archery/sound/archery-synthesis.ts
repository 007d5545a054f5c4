import { clamp } from 'threepoint/math';
import {
  lowPass,
  noiseFrom,
  normalised,
  render,
  resonator,
  type Samples,
  tau,
} from '../../scene/sound/sound-synthesis';

/**
 * Wood under strain: stick and slip, higher, denser and louder the further it is drawn; draw as a share of the most, in
 * [0, 1].
 */
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
  return normalised(samples, rate, 0.12 + 0.3 * strain);
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
  return normalised(samples, rate, 0.45 + 0.4 * strength);
}

/** An arrow goes into straw: a dull blow with a crackle. */
export function thud(rate: number): Samples {
  const noise = noiseFrom(401);
  const straw = lowPass(rate, 2200);
  const samples = render(rate, 0.35, (t) => {
    const blow = Math.sin(tau * (78 * t + 2.1 * (1 - Math.exp(-t / 0.03)))) * Math.exp(-t / 0.07);
    return blow + 0.75 * straw(noise()) * Math.exp(-t / 0.022);
  });
  return normalised(samples, rate, 0.85);
}

/** An arrow goes into the ground: lower, softer, grass about it. */
export function earth(rate: number): Samples {
  const noise = noiseFrom(503);
  const grass = lowPass(rate, 900);
  const samples = render(rate, 0.3, (t) => {
    const blow = Math.sin(tau * (52 * t + 1.1 * (1 - Math.exp(-t / 0.03)))) * Math.exp(-t / 0.05);
    return 0.8 * blow + 1.1 * grass(noise()) * Math.exp(-t / 0.05);
  });
  return normalised(samples, rate, 0.55);
}

/** An arrow is caught by a net: cords rattle. */
export function rattle(rate: number): Samples {
  const noise = noiseFrom(601);
  const low = lowPass(rate, 700);
  const samples = render(rate, 0.45, (t) => {
    const value = noise();
    return (value - low(value)) * Math.exp(-t / 0.11) * (0.35 + 0.65 * Math.max(0, Math.sin(tau * 31 * t)));
  });
  return normalised(samples, rate, 0.3);
}
