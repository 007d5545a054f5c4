import {
  avatarHashPattern,
  type BoneName,
  boneNames,
  builtInBodies,
  calibrationProblem,
  defaultCalibration,
  estimatorNames,
  handleFitParts,
  handTiltsSchema,
  skinTones,
} from 'threepoint/core';
import * as v from 'valibot';

const calibration = v.pipe(
  v.object({
    eyeHeight: v.number(),
    armSpan: v.number(),
    forearm: v.optional(v.number()),
    gazePitch: v.optional(v.number()),
    handTilts: v.optional(handTiltsSchema),
  }),
  v.check((measures) => calibrationProblem(measures) === null, 'no person has these measurements'),
);

const gripDevice = v.pipe(v.string(), v.maxLength(100));
const gripOffset = v.optional(v.record(v.picklist(handleFitParts), v.optional(v.number())));
const gripOffsets = v.pipe(
  v.record(gripDevice, v.object({ left: gripOffset, right: gripOffset })),
  v.check((offsets) => calibrationProblem({ ...defaultCalibration, gripOffsets: offsets }) === null, 'too far'),
);

const boneName = v.custom<BoneName>(
  (name) => typeof name === 'string' && boneNames.has(name),
  'there is no bone of this name',
);
/** VRM's names of bones, and what a file calls them. */
export const boneMap = v.record(
  boneName,
  v.pipe(v.string('expected the name of a bone of the file'), v.maxLength(200)),
);

const schema = v.object({
  calibration: v.optional(calibration),
  /** The user's corrections of how they hold controllers, by device; not part of a calibration that is reset. */
  gripOffsets: v.optional(gripOffsets),
  /** The device that each hand held last, which the panel corrects. */
  gripDevices: v.optional(v.object({ left: v.optional(gripDevice), right: v.optional(gripDevice) })),
  estimator: v.optional(v.picklist(estimatorNames)),
  palette: v.optional(v.pipe(v.string(), v.maxLength(32))),
  builtInBody: v.optional(v.picklist(builtInBodies)),
  skinTone: v.optional(v.picklist(skinTones)),
  upperBodyOnly: v.optional(v.boolean()),
  mirror: v.optional(v.boolean()),
  overlay: v.optional(v.boolean()),
  panel: v.optional(v.boolean()),
  bowSide: v.optional(v.picklist(['left', 'right'])),
  oneHanded: v.optional(v.boolean()),
  everyHitCounts: v.optional(v.boolean()),
  sound: v.optional(v.boolean()),
  largerText: v.optional(v.boolean()),
  singleKeys: v.optional(v.boolean()),
  bots: v.optional(v.boolean()),
  name: v.optional(v.pipe(v.string(), v.maxLength(40))),
  /** The bone maps that the user gave for files, by SHA-256. */
  bones: v.optional(v.record(v.pipe(v.string(), v.regex(avatarHashPattern)), boneMap)),
  shareAvatar: v.optional(v.boolean()),
  plainOthers: v.optional(v.boolean()),
  voicesByRelay: v.optional(v.boolean()),
  passthrough: v.optional(v.boolean()),
  gaze: v.optional(v.boolean()),
  /** The handle of the persistent anchor that the mirror stands at in passthrough. */
  mirrorAnchor: v.optional(v.pipe(v.string(), v.maxLength(200))),
});

/** The preferences that the browser stores on this device. */
export type Preferences = v.InferOutput<typeof schema>;

const key = 'threepoint.preferences.1';

type Part = { readonly [Key in keyof Preferences]: Preferences[Key] | undefined };

/** Merges a part into preferences; undefined removes an entry. */
const joined = (preferences: Preferences, part: Part): Preferences =>
  Object.fromEntries(Object.entries({ ...preferences, ...part }).filter(([, value]) => value !== undefined));

/** Reads stored preferences; anything that is not what we wrote is refused as a whole, with a sentence. */
export function parsePreferences(text: string | null): { preferences: Preferences; complaint: string | null } {
  if (text === null) return { preferences: {}, complaint: null };
  try {
    const result = v.safeParse(schema, JSON.parse(text));
    if (result.success) return { preferences: result.output, complaint: null };
    const [issue] = result.issues;
    const where = v.getDotPath(issue) ?? 'the whole';
    return {
      preferences: {},
      complaint: `The stored calibration and settings are damaged (${where}), so the defaults apply. Calibrate again to store a new calibration.`,
    };
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    return {
      preferences: {},
      complaint:
        'The stored calibration and settings are unreadable, so the defaults apply. Calibrate again to store a new calibration.',
    };
  }
}

const denied =
  'This browser does not let the page store anything, so calibration and settings are lost when you close it.';

/**
 * Keeps preferences in a storage (localStorage); null: the browser grants none. `onDenied` is called once if the
 * storage refuses to store.
 */
export function createPreferenceStore(
  storage: Pick<Storage, 'getItem' | 'setItem'> | null,
  onDenied: (sentence: string) => void = () => undefined,
) {
  const read = parsePreferences(storage?.getItem(key) ?? null);
  let preferences = read.preferences;
  let reported = false;
  /** Whether the last write of this window succeeded. */
  let kept = true;

  /** Reads the storage again, because another window may have written to it; null: nothing usable is stored. */
  function stored(): Preferences | null {
    const text = storage?.getItem(key) ?? null;
    const { preferences, complaint } = parsePreferences(text);
    return text === null || complaint !== null ? null : preferences;
  }

  function reportDenial(): void {
    if (!reported) onDenied(denied);
    reported = true;
  }
  if (storage === null) reportDenial();

  return {
    get preferences(): Preferences {
      return preferences;
    },
    /** Why what was stored could not be used; null: it could. */
    complaint: read.complaint,
    /** Remembers a part; undefined forgets it. Where the browser stores nothing, it lasts as long as the page. */
    remember(part: Part): void {
      preferences = joined(preferences, part);
      try {
        if (kept) preferences = joined(stored() ?? preferences, part);
        kept = false;
        storage?.setItem(key, JSON.stringify(preferences));
        kept = true;
      } catch (error) {
        // A full or forbidden storage affects only later visits.
        if (!(error instanceof DOMException)) throw error;
        reportDenial();
      }
    },
  };
}

export type PreferenceStore = ReturnType<typeof createPreferenceStore>;

/** Returns a storage of the browser; null: a policy or a private window forbids it. */
export function browserStorage<Name extends 'localStorage' | 'sessionStorage' | 'caches'>(
  name: Name,
): Window[Name] | null {
  try {
    // Without a secure context there are no caches.
    return window[name] ?? null;
  } catch (error) {
    if (error instanceof DOMException) return null;
    throw error;
  }
}
