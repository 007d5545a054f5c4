import type { Side } from '../math/side';

/**
 * A part of a body that the name of a joint can mean. `finger` is a finger known by its number alone,
 * `appendage` what humans lack or wear.
 */
export type Part =
  | 'hips'
  | 'spine'
  | 'neck'
  | 'head'
  | 'jaw'
  | 'eye'
  | 'shoulder'
  | 'upperArm'
  | 'lowerArm'
  | 'hand'
  | 'upperLeg'
  | 'lowerLeg'
  | 'foot'
  | 'toes'
  | 'metacarpal'
  | 'thumb'
  | 'index'
  | 'middle'
  | 'ring'
  | 'little'
  | 'finger'
  | 'appendage';

/** The side and parts that the name of a joint suggests. */
export interface NameVotes {
  readonly side: Side | null;
  /** How strongly the name means a part, from 0 to 1. */
  readonly parts: Readonly<Partial<Record<Part, number>>>;
  /** Whether the name is one of helpers, controls, ends of chains, hair and clothes, which are no bones of the body. */
  readonly auxiliary: boolean;
  /** The numbers that follow the last word of the name, in their order. */
  readonly numbers: readonly number[];
}

const sideWords: Readonly<Record<string, Side>> = {
  ...{ l: 'left', left: 'left', lft: 'left', lt: 'left' },
  ...{ r: 'right', right: 'right', rgt: 'right', rt: 'right' },
};

/** The words that programs put before or after the names of all bones. */
const noise = new Set(
  'j b c f cc base def org mixamorig bip biped valve skeleton armature bone joint jnt jt rig character skel sk'.split(
    ' ',
  ),
);

/** The words for appendages: what humans lack or wear. */
const appendageWords = new Set(
  (
    'hair skirt cape coat cloth tail wing weapon breast boob bust ear pack backpack bag hat helmet sleeve ribbon dress ' +
    'ponytail bangs tassel belt scarf beard pocket holster'
  ).split(' '),
);

const auxiliaryWords = new Set([
  ...appendageWords,
  ...(
    'twist roll ik pole ctrl control target helper end nub tip site effector prop socket slot attach jiggle dyn phys ' +
    'corrective muscle handle gizmo mch vis tweak heel null offset tongue teeth lip brow cheek nose lid eyelid chin ' +
    'fraction bend'
  ).split(' '),
]);

type Votes = NameVotes['parts'];

/** The patterns of names without side and number. The first that matches counts. */
const patterns: readonly (readonly [RegExp, Votes])[] = [
  [/carpal|^inhand/, { metacarpal: 1 }],
  [/thumb/, { thumb: 1 }],
  [/^(hand|finger)?(index|pointer)/, { index: 1 }],
  [/^(hand|finger)?(middle|mid)(?!spine)/, { middle: 1 }],
  [/^(hand|finger)?ring/, { ring: 1 }],
  [/little|pinky|pinkie/, { little: 1 }],
  [/finger|digit/, { finger: 1 }],
  [/toe|ball/, { toes: 1 }],
  [/spine|abdomen|waist|torso|chest|thorax|lowerback|upperback|^back$|belly|stomach|rib/, { spine: 1 }],
  [/lowerarm|lowarm|forearm|elbow|radius|ulna/, { lowerArm: 1 }],
  [/upperarm|uparm|humerus|shldr|bicep/, { upperArm: 1 }],
  [/clavicle|collar|clav/, { shoulder: 1 }],
  [/shoulder|scapula/, { shoulder: 0.6, upperArm: 0.55 }],
  [/wrist/, { hand: 1 }],
  [/hand/, { hand: 0.85 }],
  [/palm/, { hand: 0.6, metacarpal: 0.5 }],
  [/arm/, { upperArm: 0.75 }],
  [/upperleg|upleg|thigh|femur/, { upperLeg: 1 }],
  [/lowerleg|lowleg|calf|shin|knee|tibia/, { lowerLeg: 1 }],
  [/ankle/, { foot: 1 }],
  [/foot/, { foot: 0.85, toes: 0.3 }],
  [/leg/, { lowerLeg: 0.6, upperLeg: 0.45 }],
  [/neck/, { neck: 1 }],
  [/(?<!fore)head|skull/, { head: 1 }],
  [/jaw/, { jaw: 1 }],
  [/^eye(ball)?$/, { eye: 1 }],
  [/hips|pelvis/, { hips: 1 }],
  [/hip/, { hips: 0.9 }],
  [/root|cog|center|body/, { hips: 0.2 }],
];

const votesOf = (text: string): Votes => patterns.find(([pattern]) => pattern.test(text))?.[1] ?? {};

/** Splits a word that begins or ends with a side, such as `leftarm`, `lhumerus`. */
function splitSide(word: string): readonly string[] {
  const whole = /^(left|right)(.+)$/.exec(word) ?? /^([lr])(.+)$/.exec(word);
  if (whole && (whole[1]!.length > 1 || (known(whole[2]!) && !known(word)))) return [whole[1]!, whole[2]!];
  const last = /^(.+)(left|right)$/.exec(word);
  return last ? [last[2]!, last[1]!] : [word];
}

/** Returns whether a word without separators begins with the name of a part. */
const known = (word: string): boolean => {
  const found = patterns.find(([pattern]) => pattern.test(word));
  return found !== undefined && word.search(new RegExp(found[0].source.replace(/^\^/, ''))) === 0;
};

/** Returns the words of a name in lower case: parts of camel case, and numbers. */
const wordsOf = (name: string): readonly string[] =>
  name
    .replace(/^.*[:|](?=.)/, '')
    .replace(/([a-z])([A-Z])/g, '$1 $2')
    .replace(/([A-Z]+)([A-Z][a-z])/g, '$1 $2')
    .toLowerCase()
    .match(/[a-z]+|\d+/g) ?? [];

/** Returns what the name of a joint suggests: any prefix, any order of side and part. */
export function readJointName(name: string): NameVotes {
  let side: Side | null = null;
  let auxiliary = false;
  let numbers: number[] = [];
  const words: string[] = [];
  for (const word of wordsOf(name.slice(-100)).flatMap((each) => (sideWords[each] ? [each] : splitSide(each)))) {
    if (sideWords[word]) side = sideWords[word];
    else if (/^\d/.test(word)) numbers.push(Number(word));
    else {
      numbers = [];
      auxiliary ||= auxiliaryWords.has(word) || word.includes('twist');
      if (!noise.has(word)) words.push(word);
    }
  }
  let parts = votesOf(words.join(''));
  if (Object.keys(parts).length === 0 && words.some((word) => appendageWords.has(word))) parts = { appendage: 1 };
  // The hip of one side is the joint of its leg.
  if (side && parts.hips) parts = { upperLeg: parts.hips === 0.9 ? 0.8 : 0.2 };
  return { side, parts, auxiliary, numbers };
}
