import { beforeEach, describe, expect, test, vi } from 'vitest';
import { Measuring } from '../../../src/app/shell/controls/measuring';
import { type Calibration, defaultCalibration } from '../../../src/core/body/calibration';
import type { Emulator } from '../../../src/xr/emulator';

/** As much of an element as the dialog needs. */
class Element extends EventTarget {
  readonly dataset: Record<string, string> = {};
  textContent = '';
  hidden = false;
  value = 0;
  open = false;
  readonly setAttribute = () => undefined;
  readonly append = () => undefined;
  showModal(): void {
    this.open = true;
  }
  close(): void {
    this.open = false;
  }
}

beforeEach(() => vi.stubGlobal('document', { createElement: () => new Element(), body: new Element() }));

/** A page at a desk whose user may be measured; what is told and remembered is written down. */
function page({ actor = false, emulator = null as Emulator | null } = {}) {
  const told: string[] = [];
  const remembered: Calibration[] = [];
  const measuring = new Measuring({
    settings: { actor },
    headset: { worn: false, emulator },
    body: { wearerCalibration: defaultCalibration },
    wearer: { calibrateForGood: (calibration) => void remembered.push(calibration) },
    notices: { show: (_, text) => void told.push(text) },
  });
  return { measuring, told, remembered };
}

describe('calibrating at a desk', () => {
  test('with the actor off and a real headset to put on first says so, and opens no countdown', () => {
    const { measuring, told } = page();
    measuring.start();
    expect(measuring.step).toBeNull();
    expect(told).toEqual([expect.stringContaining('enter VR first')]);
  });

  test('begins where the user moves the emulated headset, and not where the actor does', () => {
    const emulator = {} as Emulator;
    const user = page({ emulator });
    user.measuring.start();
    expect(user.measuring.step?.kind).toBe('countdown');
    const watching = page({ actor: true, emulator });
    watching.measuring.start();
    expect(watching.measuring.step).toBeNull();
    expect(watching.told).toHaveLength(1);
  });
});
