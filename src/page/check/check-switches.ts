import { readSwitches, type Switches } from '../shell/session/switches';

/** What the address of the check asks for. */
interface CheckSwitches extends Pick<Switches, 'emulate' | 'cameras' | 'quality'> {
  /** The factor of all durations. */
  readonly pace: number;
  /** The problems of the address, one sentence each. */
  readonly complaints: readonly string[];
}

const quickest = 0.05;
/** The page's own switches that the check uses. It ignores the others, and their values. */
const used: readonly string[] = ['emulate', 'cameras', 'quality'] satisfies (keyof Switches)[];

/** Reads the query of an address. A wrong value is reported and ignored. */
export function readCheckSwitches(query: string): CheckSwitches {
  const asked = new URLSearchParams(query);
  const own = new URLSearchParams([...asked].filter(([key]) => used.includes(key)));
  const { switches, complaints } = readSwitches(`${own}`);
  const { emulate, cameras, quality } = switches;
  const given = asked.get('pace') ?? '1';
  const pace = Number(given);
  if (pace >= quickest && pace <= 1) return { emulate, cameras, quality, pace, complaints };
  const complaint = `The address has pace=${given}: pace takes a number from ${quickest} to 1.`;
  return { emulate, cameras, quality, pace: 1, complaints: [...complaints, complaint] };
}
