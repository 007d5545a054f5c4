import { readSwitches, type Switches } from '../shell/session/switches';

/** What the address of the check asks for. */
interface CheckSwitches extends Pick<Switches, 'emulate' | 'cameras' | 'quality'> {
  /** The factor of all durations. */
  readonly pace: number;
  /** The problems of the address, one sentence each. */
  readonly complaints: readonly string[];
}

const quickest = 0.05;

/** Reads the query of an address: the page's own switches, and the pace. A wrong value is reported and ignored. */
export function readCheckSwitches(query: string): CheckSwitches {
  const { switches, complaints } = readSwitches(query);
  const { emulate, cameras, quality } = switches;
  const given = new URLSearchParams(query).get('pace') ?? '1';
  const pace = Number(given);
  if (pace >= quickest && pace <= 1) return { emulate, cameras, quality, pace, complaints };
  const complaint = `The address has pace=${given}: pace takes a number from ${quickest} to 1.`;
  return { emulate, cameras, quality, pace: 1, complaints: [...complaints, complaint] };
}
