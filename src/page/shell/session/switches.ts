import { estimatorNames, threePointNames } from 'threepoint/core';
import * as v from 'valibot';
import { truthPlaces } from '../../mocap/truth-places';
import { viewNames } from '../../scene/desktop-view';
import { home, placeNames } from '../activity-registry';

const onOff = v.picklist(['on', 'off']);
const address = v.pipe(v.string(), v.minLength(1));
const wholeNumber = (least: number, most: number) =>
  v.pipe(v.string(), v.regex(/^\d{1,9}$/), v.transform(Number), v.minValue(least), v.maxValue(most));
const schema = v.object({
  actor: v.optional(onOff, 'on'),
  panel: v.optional(onOff),
  estimator: v.optional(v.picklist(estimatorNames)),
  ep: v.optional(v.picklist(['wasm', 'webgpu']), 'wasm'),
  avatar: v.optional(address),
  quality: v.optional(v.picklist(['high', 'low'])),
  replay: v.optional(address),
  mocap: v.optional(address),
  clip: v.optional(wholeNumber(1, 9999)),
  at: v.optional(v.pipe(v.string(), v.regex(/^\d{1,5}(\.\d{1,6})?$/), v.transform(Number))),
  beside: v.optional(v.picklist(threePointNames)),
  truth: v.optional(v.picklist(truthPlaces)),
  view: v.optional(v.picklist(viewNames)),
  play: v.optional(v.picklist(placeNames), home),
  seconds: v.optional(wholeNumber(1, 3600)),
  room: v.optional(v.pipe(v.string(), v.regex(/^[a-z0-9][a-z0-9-]{0,31}$/))),
  bots: v.optional(onOff),
  name: v.optional(v.pipe(v.string(), v.minLength(1), v.maxLength(40))),
  balls: v.optional(wholeNumber(1, 20)),
  seed: v.optional(wholeNumber(0, 999_999_999)),
  study: v.optional(v.pipe(v.string(), v.regex(/^[a-z0-9][a-z0-9-]{0,47}$/))),
  participant: v.optional(v.pipe(v.string(), v.regex(/^P\d{2,3}$/))),
});

/** The valid values of each switch, in words. */
const takes: Readonly<Record<keyof typeof schema.entries, string>> = {
  actor: 'on or off',
  panel: 'on or off',
  estimator: oneOf(estimatorNames),
  ep: 'wasm or webgpu',
  avatar: 'the address of a VRM or a humanoid GLB',
  quality: 'high or low',
  replay: 'the address of a recording',
  mocap: 'the addresses of a BVH, of a VRM Animation, or of an AMC and its ASF with a space between them',
  clip: 'a whole number from 1 to 9999',
  at: 'a number of seconds',
  beside: oneOf(threePointNames),
  truth: oneOf(truthPlaces),
  view: oneOf(viewNames),
  play: oneOf(placeNames),
  seconds: 'a whole number from 1 to 3600',
  room: 'lower-case letters, digits and hyphens, up to 32, not starting with a hyphen',
  bots: 'on or off',
  name: 'a name of 1 to 40 characters',
  balls: 'a whole number from 1 to 20',
  seed: 'a whole number from 0 to 999999999',
  study: 'the id of a study: lower-case letters, digits and hyphens',
  participant: 'a code such as P01',
};

function oneOf(values: readonly string[]): string {
  return `${values.slice(0, -1).join(', ')} or ${values.at(-1)}`;
}

/** A sentence about a value that its switch does not take. */
function complaintOf(key: keyof typeof takes, value: string): string {
  const shown = value.length > 40 ? `${value.slice(0, 40)}…` : value;
  const problem =
    value === ''
      ? `The address has ${key}= without a value`
      : `The address has ${key}=${shown}, which is not a valid value`;
  return `${problem}: ${key} takes ${takes[key]}.`;
}

function mocapOf({ mocap, clip, at, beside, truth }: v.InferOutput<typeof schema>) {
  if (mocap === undefined) return null;
  return { addresses: mocap.split(/\s+/), clip: clip && clip - 1, at, beside, truth };
}

/**
 * Returns what the address asks for; null: nothing asked, the page decides. `flag`: whether the query has a switch
 * without a value. Listed in src/page/README.md.
 */
const switchesOf = (output: v.InferOutput<typeof schema>, flag: (name: string) => boolean) => ({
  emulate: flag('emulate'),
  actor: output.actor === 'on',
  /** Whether the controls are open; null: as they were left. */
  panel: output.panel ? output.panel === 'on' : null,
  estimator: output.estimator ?? null,
  executionProvider: output.ep,
  avatar: output.avatar ?? null,
  quality: output.quality ?? null,
  replay: output.replay ?? null,
  /** The addresses of the files of one motion, and how it is shown; null: none is requested. */
  mocap: mocapOf(output),
  view: output.view ?? null,
  /** What the page opens with. */
  play: output.play,
  /** The seed of the first round's layout; null: a random one. */
  seed: output.seed ?? null,
  /** The length of a round [s]; null: the default of the game. */
  seconds: output.seconds ?? null,
  /** A study and its participant (null: the page asks); null: no study. */
  study: output.study === undefined ? null : { study: output.study, participant: output.participant ?? null },
  /** The room on the server; null: a room in this page. */
  room: output.room ?? null,
  /** The user watches, with a free camera. */
  spectate: flag('spectate'),
  /** Whether bots take free seats; null: in a room of one's own they do. */
  bots: output.bots ? output.bots === 'on' : null,
  /** What the others call the player of this page; null: the page asks. */
  name: output.name ?? null,
  /** The number of balls in a game in this page; null: the default of the game. */
  balls: output.balls ?? null,
});

export type Switches = Readonly<ReturnType<typeof switchesOf>>;

/** Reads the query of the address. A value that a switch does not take counts as not given and yields a sentence. */
export function readSwitches(query: string): { readonly switches: Switches; readonly complaints: readonly string[] } {
  const given = Object.fromEntries(new URLSearchParams(query));
  const complaints: string[] = [];
  let result = v.safeParse(schema, given);
  while (!result.success) {
    for (const issue of result.issues) {
      const key = issue.path?.[0]?.key as keyof typeof takes;
      if (!(key in given)) continue;
      complaints.push(complaintOf(key, given[key] ?? ''));
      delete given[key];
    }
    result = v.safeParse(schema, given);
  }
  const flag = (name: string): boolean => name in given && given[name] !== 'off';
  return { complaints, switches: switchesOf(result.output, flag) };
}
