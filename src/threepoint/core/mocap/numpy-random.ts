/**
 * The normal numbers that `numpy.random.default_rng(seed).normal()` draws: a SeedSequence seeds PCG64 (XSL-RR 128/64), whose words a ziggurat of 256
 * layers turns into them. The evaluation draws its trackers so; here they are the same ones.
 */
export class NumpyRandom {
  #state = 0n;
  readonly #increment: bigint;

  /** seed: as many as four whole numbers below 2³². */
  constructor(seed: readonly number[]) {
    const [a, b, c, d] = seedWords(seed) as [bigint, bigint, bigint, bigint];
    this.#increment = ((((c << 64n) | d) << 1n) | 1n) & mask128;
    this.#step();
    this.#state = (this.#state + ((a << 64n) | b)) & mask128;
    this.#step();
  }

  /** The next normal number, mean 0 and deviation 1. */
  normal(): number {
    for (;;) {
      const word = this.#next();
      const layer = Number(word & 0xffn);
      const sign = (word >> 8n) & 1n ? -1 : 1;
      const inLayer = Number((word >> 9n) & 0xfffffffffffffn);
      const x = sign * inLayer * ziggurat.widths[layer]!;
      if (inLayer < ziggurat.inside[layer]!) return x;
      if (layer === 0) return this.#tail((inLayer / 256) & 1 ? -1 : 1);
      const [above, here] = [ziggurat.heights[layer - 1]!, ziggurat.heights[layer]!];
      if ((above - here) * this.#uniform() + here < Math.exp(-0.5 * x * x)) return x;
    }
  }

  #tail(sign: number): number {
    for (;;) {
      const x = -Math.log1p(-this.#uniform()) / tailBegins;
      const y = -Math.log1p(-this.#uniform());
      if (y + y > x * x) return sign * (tailBegins + x);
    }
  }

  /** In [0, 1). */
  #uniform(): number {
    return Number(this.#next() >> 11n) / 2 ** 53;
  }

  #next(): bigint {
    this.#step();
    const folded = (this.#state >> 64n) ^ (this.#state & mask64);
    const turn = this.#state >> 122n;
    return ((folded >> turn) | (folded << (64n - turn))) & mask64;
  }

  #step(): void {
    this.#state = (this.#state * multiplier + this.#increment) & mask128;
  }
}

const mask64 = (1n << 64n) - 1n;
const mask128 = (1n << 128n) - 1n;
const multiplier = 0x2360ed051fc65da44385df649fccf645n;
const poolSize = 4;

/** A hash whose constant changes with every word that it takes. */
function hasher(constant: number, factor: number): (word: number) => number {
  let current = constant;
  return (word) => {
    let mixed = word ^ current;
    current = Math.imul(current, factor);
    mixed = Math.imul(mixed, current);
    return (mixed ^ (mixed >>> 16)) >>> 0;
  };
}

function mix(a: number, b: number): number {
  const mixed = Math.imul(a, 0xca01f9dd) - Math.imul(b, 0x4973f715);
  return (mixed ^ (mixed >>> 16)) >>> 0;
}

/** Four words of 64 bits. */
function seedWords(seed: readonly number[]): bigint[] {
  const take = hasher(0x43b0d7e5, 0x931e8875);
  const pool = Array.from({ length: poolSize }, (_, i) => take(seed[i] ?? 0));
  for (let from = 0; from < poolSize; from++)
    for (let to = 0; to < poolSize; to++) if (from !== to) pool[to] = mix(pool[to]!, take(pool[from]!));
  const give = hasher(0x8b51f9dd, 0x58f38ded);
  const words = Array.from({ length: 8 }, (_, i) => BigInt(give(pool[i % poolSize]!)));
  return [0, 2, 4, 6].map((i) => words[i]! | (words[i + 1]! << 32n));
}

/** The start of the lowest layer's tail, and the area of every layer. */
const tailBegins = 3.6541528853610088;
const layerArea = 0.004928673233974658;
const layers = 256;

/** Widths of the layers by a step of 52 bits, how many steps lie inside the curve at every height, heights at their far ends. */
const ziggurat = makeZiggurat();

function makeZiggurat() {
  const steps = 2 ** 52;
  const [widths, heights, inside] = [0, 1, 2].map(() => new Float64Array(layers)) as [
    Float64Array,
    Float64Array,
    Float64Array,
  ];
  const density = (x: number): number => Math.exp(-0.5 * x * x);
  const lowest = layerArea / density(tailBegins);
  inside[0] = Math.floor((tailBegins / lowest) * steps);
  widths[0] = lowest / steps;
  heights[0] = 1;
  let end = tailBegins;
  for (let i = layers - 1; i > 0; i--) {
    widths[i] = end / steps;
    heights[i] = density(end);
    const next = i > 1 ? Math.sqrt(-2 * Math.log(layerArea / end + density(end))) : 0;
    inside[i] = Math.floor((next / end) * steps);
    end = next;
  }
  return { widths, heights, inside };
}
