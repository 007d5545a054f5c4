import { expect } from 'vitest';

/** To a millionth of R's figure. */
export function expectAsInR(ours: number | null | undefined, r: number): void {
  expect(ours).not.toBeNull();
  expect(Math.abs((ours as number) - r)).toBeLessThanOrEqual(1e-6 * Math.abs(r));
}
