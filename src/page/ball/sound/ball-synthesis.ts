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

/** A ball on the floor: a short boom, the lower and louder the harder; strength in [0, 1]. */
export function bounce(rate: number, strength: number): Samples {
  const hard = clamp(strength, 0, 1);
  const noise = noiseFrom(811);
  const slap = lowPass(rate, 1500);
  const samples = render(rate, 0.22, (t) => {
    const boom = Math.sin(tau * (118 * t + 1.7 * (1 - Math.exp(-t / 0.02)))) * Math.exp(-t / 0.05);
    return boom + 0.45 * slap(noise()) * Math.exp(-t / 0.008);
  });
  return normalised(samples, rate, 0.25 + 0.45 * hard);
}

/** A ball falls into wicker: a soft blow and a rustle. */
export function caughtInWicker(rate: number): Samples {
  const noise = noiseFrom(823);
  const twigs = [resonator(rate, 1900, 500), resonator(rate, 3100, 700)] as const;
  const samples = render(rate, 0.4, (t) => {
    const blow = Math.sin(tau * 92 * t) * Math.exp(-t / 0.06);
    const push = noise() * (Math.exp(-t / 0.05) + 0.35 * Math.exp(-Math.abs(t - 0.09) / 0.02));
    return 0.8 * blow + 0.9 * (twigs[0](push) + 0.6 * twigs[1](push));
  });
  return normalised(samples, rate, 0.7);
}

/** The rim: a woody knock. */
export function knock(rate: number): Samples {
  const noise = noiseFrom(829);
  const wood = [resonator(rate, 720, 70), resonator(rate, 1480, 120)] as const;
  const samples = render(rate, 0.2, (t) => {
    const push = noise() * Math.exp(-t / 0.004);
    return wood[0](push) + 0.6 * wood[1](push);
  });
  return normalised(samples, rate, 0.55);
}

/** A referee's whistle: two trills. */
export function whistle(rate: number): Samples {
  const noise = noiseFrom(839);
  const samples = render(rate, 0.62, (t) => {
    const second = t > 0.2;
    const since = second ? t - 0.2 : t;
    const lasts = second ? 0.4 : 0.14;
    if (since > lasts) return 0;
    const swell = Math.min(1, since / 0.012) * Math.min(1, (lasts - since) / 0.03);
    const trill = 1 + 0.35 * Math.sin(tau * 38 * t);
    return (Math.sin(tau * 2350 * t + 0.9 * Math.sin(tau * 38 * t)) * trill + 0.12 * noise()) * swell;
  });
  return normalised(samples, rate, 0.3);
}

/** The last seconds: a short wooden tick. */
export function tick(rate: number): Samples {
  const noise = noiseFrom(853);
  const wood = resonator(rate, 1150, 90);
  const samples = render(rate, 0.09, (t) => wood(noise() * Math.exp(-t / 0.003)));
  return normalised(samples, rate, 0.22);
}
