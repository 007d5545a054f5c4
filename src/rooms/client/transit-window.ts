/** Initial capacity: more than 5 s of 30 packets a second. */
const firstCapacity = 256;

/** The transit times of the packets of the last seconds, in order of arrival and sorted. Reuses its buffers. */
export class TransitWindow {
  private arrivals = new Float64Array(firstCapacity);
  private transits = new Float64Array(firstCapacity);
  private sorted = new Float64Array(firstCapacity);
  private first = 0;
  private count = 0;

  /** `memory`: packets that arrived longer ago than this [s] are dropped. */
  constructor(private readonly memory: number) {}

  clear(): void {
    this.first = 0;
    this.count = 0;
  }

  /** Adds a packet that arrived at this time [s] with this transit time [s, plus the offset of the two clocks]. */
  add(arrivedAt: number, transit: number): void {
    if (this.count === this.sorted.length) this.grow();
    const end = (this.first + this.count) % this.sorted.length;
    this.arrivals[end] = arrivedAt;
    this.transits[end] = transit;
    const at = this.rankOf(transit);
    this.sorted.copyWithin(at + 1, at, this.count);
    this.sorted[at] = transit;
    this.count += 1;
    while (this.count > 0 && arrivedAt - this.arrivals[this.first]! > this.memory) this.forgetOldest();
  }

  /** The shortest transit [s]; 0 before the first packet. */
  get minimum(): number {
    return this.count > 0 ? this.sorted[0]! : 0;
  }

  /** The 95th percentile of the transit times above the shortest [s]. */
  get jitter(): number {
    return this.count > 0 ? this.sorted[Math.floor(this.count * 0.95)]! - this.minimum : 0;
  }

  /** Returns the number of shorter transit times. */
  private rankOf(transit: number): number {
    let from = 0;
    let to = this.count;
    while (from < to) {
      const middle = (from + to) >> 1;
      if (this.sorted[middle]! < transit) from = middle + 1;
      else to = middle;
    }
    return from;
  }

  private forgetOldest(): void {
    const at = this.rankOf(this.transits[this.first]!);
    this.sorted.copyWithin(at, at + 1, this.count);
    this.first = (this.first + 1) % this.sorted.length;
    this.count -= 1;
  }

  private grow(): void {
    const { length } = this.sorted;
    const inOrder = (ring: Float64Array): Float64Array<ArrayBuffer> => {
      const longer = new Float64Array(2 * length);
      for (let i = 0; i < this.count; i++) longer[i] = ring[(this.first + i) % length]!;
      return longer;
    };
    this.arrivals = inOrder(this.arrivals);
    this.transits = inOrder(this.transits);
    const sorted = new Float64Array(2 * length);
    sorted.set(this.sorted);
    this.sorted = sorted;
    this.first = 0;
  }
}
