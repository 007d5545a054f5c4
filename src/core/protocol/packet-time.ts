/**
 * Seconds from one time of a pose packet to another, both in milliseconds modulo 65 536 (whole times are taken too): the shorter way
 * round, in [−32.768, 32.768).
 */
export function packetSecondsBetween(fromMs: number, toMs: number): number {
  const offset = (((toMs - fromMs + 32768) % 65536) + 65536) % 65536;
  return (offset - 32768) / 1000;
}
