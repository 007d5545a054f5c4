import { expect, test } from 'vitest';
import { playPulses } from '../../../src/threepoint/xr/haptics';
import { controller, fakeHeadset } from './fake-headset';

const right = { position: { x: 0.25, y: 1.1, z: -0.35 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };

/** A controller whose actuator does this. */
function buzzing(pulse: (strength: number, milliseconds: number) => Promise<boolean>) {
  const { session, setInputs } = fakeHeadset();
  const source = controller('right', right);
  setInputs({ ...source, gamepad: { ...source.gamepad, hapticActuators: [{ pulse }] } as typeof source.gamepad });
  return session;
}

test('a pulse reaches the hand that it is for, within the strength that there is', () => {
  const felt: number[][] = [];
  const session = buzzing(async (strength, milliseconds) => felt.push([strength, milliseconds]) > 0);
  playPulses(session, [
    { side: 'right', strength: 1.5, seconds: 0.04 },
    { side: 'left', strength: 1, seconds: 1 },
  ]);
  expect(felt).toEqual([[1, 40]]);
});

test.each<[string, () => Promise<boolean>]>([
  ['rejects', () => Promise.reject(new DOMException('gone', 'InvalidStateError'))],
  [
    'throws',
    () => {
      throw new TypeError('gone');
    },
  ],
  // reason: early browsers returned nothing
  ['returns nothing', () => undefined as unknown as Promise<boolean>],
])('a controller that cannot buzz and %s stays silent', async (_, pulse) => {
  const unseen: unknown[] = [];
  const listen = (reason: unknown) => unseen.push(reason);
  process.on('unhandledRejection', listen);
  playPulses(buzzing(pulse), [{ side: 'right', strength: 1, seconds: 0.1 }]);
  await new Promise((resolve) => setTimeout(resolve, 0));
  process.off('unhandledRejection', listen);
  expect(unseen).toEqual([]);
});
