import * as v from 'valibot';
import { type EstimatorName, estimatorNames } from '../core/estimation/pose-estimator';
import { type ViewName, viewNames } from '../scene/desktop-view';
import type { Quality } from '../scene/renderer';
import { type ActivityName, activityNames } from './play-bar';

/** What the address asks for; null: nothing asked, the page decides. Listed in docs/page.md. */
export interface Switches {
  readonly emulate: boolean;
  readonly actor: boolean;
  readonly estimator: EstimatorName | null;
  readonly executionProvider: 'wasm' | 'webgpu';
  readonly avatar: string | null;
  readonly quality: Quality | null;
  readonly replay: string | null;
  readonly view: ViewName | null;
  readonly panel: boolean;
  /** What the page opens with. */
  readonly play: ActivityName;
  /** Of the first round's layout; null: another one with each visit. */
  readonly seed: number | null;
  /** Of a round, until the bell [s]; null: as the game has it. */
  readonly seconds: number | null;
  /** A study and who takes part in it (null: to be asked); null: no study. */
  readonly study: { readonly study: string; readonly participant: string | null } | null;
  /** Where others play too; null: a room in this page. */
  readonly room: string | null;
  /** Watches, from a camera of its own. */
  readonly spectate: boolean;
  /** Whether bots take free seats; null: in a room of one's own they do. */
  readonly bots: boolean | null;
  /** What the others call whoever plays here; null: the page asks. */
  readonly name: string | null;
  /** Of a ball game in this page; null: as the game has it. */
  readonly balls: number | null;
}

const onOff = v.optional(v.picklist(['on', 'off']), 'on');
const schema = v.object({
  actor: onOff,
  panel: onOff,
  estimator: v.optional(v.picklist(estimatorNames)),
  ep: v.optional(v.picklist(['wasm', 'webgpu']), 'wasm'),
  avatar: v.optional(v.pipe(v.string(), v.minLength(1))),
  quality: v.optional(v.picklist(['high', 'low'])),
  replay: v.optional(v.pipe(v.string(), v.minLength(1))),
  view: v.optional(v.picklist(viewNames)),
  play: v.optional(v.picklist(activityNames), 'studio'),
  seconds: v.optional(v.pipe(v.string(), v.regex(/^\d{1,4}$/), v.transform(Number), v.minValue(1))),
  room: v.optional(v.pipe(v.string(), v.regex(/^[a-z0-9][a-z0-9-]{0,31}$/))),
  bots: v.optional(v.picklist(['on', 'off'])),
  name: v.optional(v.pipe(v.string(), v.minLength(1), v.maxLength(40))),
  balls: v.optional(v.pipe(v.string(), v.regex(/^\d{1,2}$/), v.transform(Number), v.minValue(1), v.maxValue(20))),
  seed: v.optional(v.pipe(v.string(), v.regex(/^\d{1,9}$/), v.transform(Number))),
  study: v.optional(v.pipe(v.string(), v.regex(/^[a-z0-9][a-z0-9-]{0,47}$/))),
  participant: v.optional(v.pipe(v.string(), v.regex(/^P\d{2,3}$/))),
});

/** Reads the query of the address. A value nobody knows counts as not given and yields a sentence. */
export function readSwitches(query: string): { readonly switches: Switches; readonly complaints: readonly string[] } {
  const given = Object.fromEntries(new URLSearchParams(query));
  const complaints: string[] = [];
  let result = v.safeParse(schema, given);
  while (!result.success) {
    for (const issue of result.issues) {
      const key = String(issue.path?.[0]?.key ?? '');
      const expected = issue.expected ? `; it takes ${issue.expected}` : '';
      complaints.push(`The address says ${key}=${given[key]}, which this page does not know${expected}.`);
      delete given[key];
    }
    result = v.safeParse(schema, given);
  }
  const { output } = result;
  return {
    complaints,
    switches: {
      emulate: 'emulate' in given && given.emulate !== 'off',
      actor: output.actor === 'on',
      panel: output.panel === 'on',
      estimator: output.estimator ?? null,
      executionProvider: output.ep,
      avatar: output.avatar ?? null,
      quality: output.quality ?? null,
      replay: output.replay ?? null,
      view: output.view ?? null,
      play: output.play,
      seed: output.seed ?? null,
      seconds: output.seconds ?? null,
      study: output.study === undefined ? null : { study: output.study, participant: output.participant ?? null },
      room: output.room ?? null,
      spectate: 'spectate' in given && given.spectate !== 'off',
      bots: output.bots ? output.bots === 'on' : null,
      name: output.name ?? null,
      balls: output.balls ?? null,
    },
  };
}
