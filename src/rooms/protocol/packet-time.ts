/** Times of packets begin anew after so long [ms]; a power of two. */
const turnMs = 2 ** 14;

/** A time [ms] as a packet tells it: whole, modulo 16 384. */
export const packetMs = (ms: number): number => Math.round(ms) & (turnMs - 1);

/**
 * Seconds from one time of a pose packet to another, both in milliseconds modulo 16 384 (whole times are taken too): the shorter way
 * round, in [−8.192, 8.192).
 */
export function packetSecondsBetween(fromMs: number, toMs: number): number {
  const half = turnMs / 2;
  const offset = (((toMs - fromMs + half) % turnMs) + turnMs) % turnMs;
  return (offset - half) / 1000;
}
