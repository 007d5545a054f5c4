import { estimatorNames, threePointNames } from 'threepoint/core';
import * as v from 'valibot';
import { truthPlaces } from '../../mocap/truth-places';
import { viewNames } from '../../scene/desktop-view';
import { home, placeNames } from '../activity-registry';

// The message of each validator describes the valid values in words.
const oneOf = <const Names extends readonly string[]>(names: Names) =>
  v.picklist(names, `${names.slice(0, -1).join(', ')} or ${names.at(-1)}`);
const text = (pattern: RegExp, description: string) => v.pipe(v.string(), v.regex(pattern, description));
const addressOf = (target: string) => v.pipe(v.string(), v.nonEmpty(target));
const wholeNumber = (least: number, most: number) => {
  const description = `a whole number from ${least} to ${most}`;
  return v.pipe(
    text(/^\d{1,9}$/, description),
    v.transform(Number),
    v.minValue(least, description),
    v.maxValue(most, description),
  );
};
const onOff = v.pipe(
  oneOf(['on', 'off']),
  v.transform((value) => value === 'on'),
);
/** A switch without a value, which no value but `off` withdraws. */
const flag = v.optional(
  v.pipe(
    v.string(),
    v.transform((value) => value !== 'off'),
  ),
  'off',
);
/** A switch that, when it is not given, leaves the decision to the page. */
const open = <Schema extends v.GenericSchema>(schema: Schema) => v.nullish(schema, null);

/** What the address asks for. Listed in src/page/README.md. */
const entries = {
  emulate: flag,
  /** Whether hands outside of the view of a headset's cameras are lost. */
  cameras: flag,
  actor: v.optional(onOff, 'on'),
  /** Whether the controls are open; null: as they were left. */
  panel: open(onOff),
  estimator: open(oneOf(estimatorNames)),
  /** The provider of onnxruntime-web in which networks run; null: only those that need it, in WebAssembly. */
  ep: open(oneOf(['wasm', 'webgpu'])),
  avatar: open(addressOf('the address of a VRM or a humanoid GLB')),
  quality: open(oneOf(['high', 'low'])),
  replay: open(addressOf('the address of a recording')),
  view: open(oneOf(viewNames)),
  /** What the page opens with. */
  play: v.optional(oneOf(placeNames), home),
  /** The seed of the first round's layout; null: a random one. */
  seed: open(wholeNumber(0, 999_999_999)),
  /** The length of a round [s]; null: the default of the game. */
  seconds: open(wholeNumber(1, 3600)),
  /** The room on the server; null: a room in this page. */
  room: open(
    text(/^[a-z0-9][a-z0-9-]{0,31}$/, 'lower-case letters, digits and hyphens, up to 32, not starting with a hyphen'),
  ),
  /** The user watches, with a free camera. */
  spectate: flag,
  /** Whether bots take free seats; null: in a room of one's own they do. */
  bots: open(onOff),
  /** What the others call the player of this page; null: the page asks. */
  name: open(text(/^.{1,40}$/s, 'a name of 1 to 40 characters')),
  /** The number of balls in a game in this page; null: the default of the game. */
  balls: open(wholeNumber(1, 20)),
};

const mocapEntries = {
  mocap: v.optional(
    addressOf('the addresses of a BVH, of a VRM Animation, or of an AMC and its ASF with a space between them'),
  ),
  clip: v.optional(wholeNumber(1, 9999)),
  at: v.optional(v.pipe(text(/^\d{1,5}(\.\d{1,6})?$/, 'a number of seconds'), v.transform(Number))),
  beside: v.optional(oneOf(threePointNames)),
  truth: v.optional(oneOf(truthPlaces)),
};

const studyEntries = {
  study: open(text(/^[a-z0-9][a-z0-9-]{0,47}$/, 'the id of a study: lower-case letters, digits and hyphens')),
  participant: open(text(/^P\d{2,3}$/, 'a code such as P01')),
};

const schema = v.pipe(
  v.object({ ...entries, ...mocapEntries, ...studyEntries }),
  v.transform(({ mocap, clip, at, beside, truth, study, participant, ...switches }) => ({
    ...switches,
    /** The addresses of the files of one motion, and how it is shown; null: none is requested. */
    mocap: mocap === undefined ? null : { addresses: mocap.split(/\s+/), clip: clip && clip - 1, at, beside, truth },
    /** A study and its participant (null: the page asks); null: no study. */
    study: study === null ? null : { study, participant },
  })),
);

export type Switches = Readonly<v.InferOutput<typeof schema>>;

/** A sentence about a value that its switch does not take. */
function complaintOf(key: string, value: string, valid: string): string {
  const shown = value.length > 40 ? `${value.slice(0, 40)}…` : value;
  const problem =
    value === ''
      ? `The address has ${key}= without a value`
      : `The address has ${key}=${shown}, which is not a valid value`;
  return `${problem}: ${key} takes ${valid}.`;
}

/** Reads the query of the address. A value that a switch does not take counts as not given and yields a sentence. */
export function readSwitches(query: string): { readonly switches: Switches; readonly complaints: readonly string[] } {
  const given = Object.fromEntries(new URLSearchParams(query));
  const complaints: string[] = [];
  for (const { path, message } of v.safeParse(schema, given).issues ?? []) {
    const key = String(path?.[0]?.key);
    complaints.push(complaintOf(key, given[key] ?? '', message));
    delete given[key];
  }
  return { complaints, switches: v.parse(schema, given) };
}
