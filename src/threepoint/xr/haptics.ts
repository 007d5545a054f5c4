import type { HapticPulse } from '../core/input/haptic-pulse';

/** Plays pulses on the controllers; devices without an actuator stay silent. */
export function playPulses(session: XRSession, pulses: readonly HapticPulse[]): void {
  for (const { side, strength, seconds } of pulses) {
    for (const { handedness, gamepad } of session.inputSources) {
      if (handedness !== side) continue;
      // Quest and Vive offer `pulse` on the first actuator, which no type knows yet.
      const [actuator] = (gamepad as { hapticActuators?: readonly PulseActuator[] } | undefined)?.hapticActuators ?? [];
      if (actuator) void tryPulse(actuator, Math.min(1, Math.max(0, strength)), 1000 * seconds);
    }
  }
}

async function tryPulse(actuator: PulseActuator, strength: number, milliseconds: number): Promise<void> {
  try {
    await actuator.pulse?.(strength, milliseconds);
  } catch {
    // reason: a controller that was put away rejects, which is no fault of the page
  }
}

interface PulseActuator {
  pulse?(strength: number, milliseconds: number): Promise<boolean>;
}
