import { angleBetween, type Quat } from 'threepoint/math';
import { expect } from 'vitest';

declare module 'vitest' {
  // biome-ignore lint/suspicious/noExplicitAny: the type parameter must be declared as vitest declares it.
  interface Matchers<T = any> {
    /** Within `degrees` of the expected rotation; q and −q are the same rotation. */
    toBeSameRotationAs(expected: Quat, degrees?: number): T;
  }
}

const shown = ({ x, y, z, w }: Quat): string => `(${[x, y, z, w].map((part) => part.toFixed(6)).join(', ')})`;

expect.extend({
  toBeSameRotationAs(received: Quat, expected: Quat, degrees = 1e-6) {
    const apart = (angleBetween(received, expected) * 180) / Math.PI;
    const unit = Math.abs(Math.hypot(received.x, received.y, received.z, received.w) - 1) < 1e-6;
    return {
      // Not `>`: NaN is no rotation.
      pass: unit && apart <= degrees,
      message: () =>
        unit
          ? `expected ${shown(received)} ${this.isNot ? 'not ' : ''}to be within ${degrees}° of ${shown(expected)}: ${apart}° apart`
          : `expected a unit quaternion, got ${shown(received)}`,
    };
  },
});
