/** Times of packets wrap around after this time [ms], a power of two. */
const turnMs = 2 ** 14;

/** Returns a time as packets carry it [ms]: an integer modulo 16,384. */
export const packetMs = (ms: number): number => Math.round(ms) & (turnMs - 1);

/**
 * Returns the seconds from one packet time to another [ms], the shorter way round, in [−8.192, 8.192). Times that are
 * not wrapped are accepted too.
 */
export function packetSecondsBetween(fromMs: number, toMs: number): number {
  const half = turnMs / 2;
  const offset = (((toMs - fromMs + half) % turnMs) + turnMs) % turnMs;
  return (offset - half) / 1000;
}
