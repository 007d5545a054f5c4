import type { Quality } from '../scene/renderer';

/** What the address of the check asks for. */
interface CheckSwitches {
  /** The emulated headset replaces the browser's WebXR. */
  readonly emulate: boolean;
  /** Absent: as the machine affords. */
  readonly quality?: Quality;
  /** The factor of all durations. */
  readonly pace: number;
  /** The problems of the address, one sentence each. */
  readonly complaints: readonly string[];
}

const quickest = 0.05;

/** Reads the query of an address. A wrong value is reported and ignored. */
export function readCheckSwitches(query: string): CheckSwitches {
  const given = new URLSearchParams(query);
  const complaints: string[] = [];
  const quality = given.get('quality');
  if (quality !== null && quality !== 'high' && quality !== 'low')
    complaints.push(`?quality=${quality} is ignored: expected high or low.`);
  const pace = given.get('pace') === null ? 1 : Number(given.get('pace'));
  const known = pace >= quickest && pace <= 1;
  if (!known) complaints.push(`?pace=${given.get('pace')} is ignored: expected a number from ${quickest} to 1.`);
  return {
    emulate: given.has('emulate'),
    ...((quality === 'high' || quality === 'low') && { quality }),
    pace: known ? pace : 1,
    complaints,
  };
}
