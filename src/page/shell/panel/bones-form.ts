import { type BoneMap, type BoneName, neededBones } from 'threepoint/core/humanoid/bones';
import { button, element } from 'threepoint-ui/element';
import * as v from 'valibot';
import { boneMap } from '../preferences';
import type { WaitingForBones } from '../shown-avatar';

const words: Readonly<Partial<Record<BoneName, string>>> = {
  hips: 'Hips',
  spine: 'Spine',
  chest: 'Chest',
  upperChest: 'Upper chest',
  neck: 'Neck',
  head: 'Head',
};
const limbs = {
  Shoulder: 'shoulder (collarbone)',
  UpperArm: 'upper arm',
  LowerArm: 'forearm',
  Hand: 'hand',
  UpperLeg: 'thigh',
  LowerLeg: 'lower leg',
  Foot: 'foot',
} as const;
const limbNames = Object.keys(limbs) as (keyof typeof limbs)[];

/** The bones that have a list of their own. Fingers, toes and eyes can be given as text. */
const listed: readonly { readonly bone: BoneName; readonly label: string }[] = [
  ...Object.entries(words).map(([bone, label]) => ({ bone: bone as BoneName, label })),
  ...(['left', 'right'] as const).flatMap((side) =>
    limbNames.map((limb) => ({
      bone: `${side}${limb}` as BoneName,
      label: `${side === 'left' ? 'Left' : 'Right'} ${limbs[limb]}`,
    })),
  ),
];
const isNeeded = (bone: BoneName): boolean => (neededBones as readonly BoneName[]).includes(bone);

/** Parses a map of bones. Returns a sentence about the first fault instead. */
export function bonesIn(text: string, found: readonly string[]): BoneMap | { readonly complaint: string } {
  if (text.trim() === '') return {};
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    return { complaint: `The text is not JSON (${error.message}). Write it like {"hips": "…", "spine": "…"}.` };
  }
  const read = v.safeParse(boneMap, Array.isArray(value) ? null : value);
  if (!read.success) {
    const [issue] = read.issues;
    const where = v.getDotPath(issue);
    return {
      complaint:
        where === null
          ? 'The text is not a map of bones. Write it like {"hips": "…", "spine": "…"}.'
          : `The text says “${where}”: ${issue.message}.`,
    };
  }
  const bones = read.output as BoneMap;
  const strange = Object.entries(bones).find(([, called]) => !found.includes(called));
  return strange ? { complaint: `The text maps ${strange[0]} to “${strange[1]}”, which is not in this file.` } : bones;
}

/** A sentence about a map with which no body can be moved; null: one can. */
export function boneComplaint(bones: BoneMap): string | null {
  const missing = listed.filter(({ bone }) => isNeeded(bone) && !bones[bone]).map(({ label }) => label.toLowerCase());
  if (missing.length > 0) return `Still missing: ${missing.join(', ')}.`;
  const seen = new Map<string, string>();
  for (const [bone, called] of Object.entries(bones)) {
    const other = seen.get(called);
    if (other) return `“${called}” is mapped to both ${other} and ${bone}.`;
    seen.set(called, bone);
  }
  return null;
}

/** Lets the user write a map as text, in a section that can be folded. */
const asText = (text: HTMLTextAreaElement): HTMLElement =>
  element(
    'details',
    {},
    element('summary', {}, 'As text, including fingers and toes'),
    element('p', { class: 'hint' }, 'JSON that maps VRM’s name of a bone to the file’s. It overrides the lists.'),
    text,
  );

/** Lets the user map the bones of a file that could not be matched to a humanoid. */
export function createBonesForm(give: (bones: BoneMap) => void) {
  const title = element('h2', {}, 'Bones of this file');
  const hint = element('p', { class: 'hint' });
  const complaint = element('p', { class: 'complaint', role: 'alert' });
  const selects = listed.map(({ bone, label }) => {
    const select = element('select', {});
    const name = isNeeded(bone) ? label : `${label} (if there is one)`;
    return { bone, select, node: element('label', { class: 'bone' }, element('span', {}, name), select) };
  });
  const text = element('textarea', {
    rows: 4,
    spellcheck: 'false',
    'aria-label': 'Bone map as text: JSON, by VRM names',
    placeholder: '{"leftIndexProximal": "…"}',
  });
  let found: readonly string[] = [];
  /** The page's last complaint about given bones. */
  let told: string | null = null;

  function submit(): void {
    const written = bonesIn(text.value, found);
    if ('complaint' in written) {
      complaint.textContent = String(written.complaint);
      return;
    }
    const chosen = selects.filter(({ select }) => select.value !== '').map(({ bone, select }) => [bone, select.value]);
    const bones: BoneMap = { ...Object.fromEntries(chosen), ...written };
    const wrong = boneComplaint(bones);
    complaint.textContent = wrong ?? '';
    if (wrong === null) give(bones);
  }

  const node = element(
    'section',
    { class: 'bones' },
    title,
    hint,
    ...selects.map((each) => each.node),
    asText(text),
    complaint,
    button('Use these bones', submit, { class: 'primary' }),
  );

  /** Another file: its names in every list, those that are known chosen. */
  function fill(waiting: WaitingForBones): void {
    found = waiting.found;
    for (const { bone, select } of selects) {
      const options = found.map((name) => element('option', { value: name }, name));
      select.replaceChildren(element('option', { value: '' }, '—'), ...options);
      select.value = waiting.bones[bone] ?? '';
    }
    text.value = '';
    hint.textContent = `The ${found.length} bones of ${waiting.name} could not be matched to a humanoid. Map them by hand. The page remembers the map for this file.`;
  }

  return {
    node,
    show(waiting: WaitingForBones | null) {
      node.hidden = waiting === null;
      if (!waiting) {
        found = [];
        return;
      }
      if (waiting.found !== found) {
        fill(waiting);
        complaint.textContent = '';
      }
      if (waiting.complaint !== told) complaint.textContent = waiting.complaint ?? '';
      told = waiting.complaint;
    },
  };
}
