import type { BoneMap, BoneName } from 'threepoint/core/humanoid/bones';
import { button, element } from 'threepoint-ui/element';
import type { WaitingForBones } from '../user-avatar';
import { BoneChoices, isNeeded, labelOfPart, partGroups } from './bone-choices';
import { createSkeletonPicture } from './skeleton-picture';
import './bones-form.css';

/** Fingers, eyes and jaw are listed once a bone is one of them. */
const alwaysListed = 5;

/** What the form does with the user's map. */
interface BonesActions {
  /** null: forgets the user's map. */
  give(bones: BoneMap | null): void;
  cancel(): void;
}

/** Lets the user map the bones of one file: on a picture, and by a list. */
function createMapping(waiting: WaitingForBones, { give, cancel }: BonesActions) {
  const choices = new BoneChoices(waiting);
  /** The bone that is chosen, and the part that the user wants to find on the picture. */
  let chosen: number | null = null;
  let wanted: BoneName | null = null;

  const picture = createSkeletonPicture(choices, (joint) => {
    if (wanted) choices.assign(joint, wanted);
    choose(joint);
  });
  const called = element('span', {});
  const groups = partGroups.map(({ label, parts }) =>
    element('optgroup', { label }, ...parts.map(([part, label]) => element('option', { value: part }, label))),
  );
  const select = element('select', {}, element('option', { value: '' }, 'no part of the body'), ...groups);
  const bone = element('label', { class: 'bone' }, called, select);
  const hint = element('p', { class: 'hint', role: 'status' });
  select.addEventListener('change', () => {
    if (chosen !== null) choices.assign(chosen, select.value === '' ? null : (select.value as BoneName));
    choose(chosen);
  });
  const listed = partGroups.flatMap(({ label, parts }, group) => {
    const rows = parts.map(([part]) => ({
      part,
      always: group < alwaysListed && (isNeeded(part) || !/Eye$|^jaw$|Toes$/.test(part)),
      // The group has the side.
      node: button(labelOfPart(part).replace(/^(Left|Right) (?!eye)/, ''), () => {
        const joint = choices.jointOf(part);
        choose(joint < 0 ? null : joint, joint < 0 ? part : null);
        picture.node.scrollIntoView({ block: 'nearest' });
      }),
    }));
    const node = element(
      'div',
      { class: 'parts', role: 'group', 'aria-label': label },
      element('span', { 'aria-hidden': 'true' }, label),
      ...rows.map(({ node }) => node),
    );
    return { node, rows };
  });

  function choose(joint: number | null, part: BoneName | null = null): void {
    chosen = joint;
    wanted = part;
    picture.show(chosen);
    bone.hidden = chosen === null;
    called.textContent = chosen === null ? '' : `${choices.joints[chosen]!.name} is`;
    const current = chosen === null ? wanted : choices.partOf(chosen);
    select.value = (chosen !== null && current) || '';
    hint.textContent = wanted ? `Choose the bone of the ${labelOfPart(wanted).toLowerCase()} on the picture.` : '';
    for (const { node, rows } of listed) {
      for (const { part: each, always, node } of rows) {
        const joint = choices.jointOf(each);
        node.hidden = joint < 0 && !always;
        node.title = joint < 0 ? (isNeeded(each) ? 'missing' : 'not mapped') : choices.joints[joint]!.name;
        node.className =
          joint < 0 ? (isNeeded(each) ? 'missing' : 'none') : choices.isUnsure(joint) ? 'unsure' : 'sure';
        node.setAttribute('aria-label', `${labelOfPart(each)}: ${node.title}`);
        node.setAttribute('aria-pressed', String(each === current));
      }
      node.hidden = rows.every(({ node }) => node.hidden);
    }
  }

  const complaint = element('p', { class: 'complaint', role: 'alert' });
  function submit(): void {
    const { missing } = choices;
    const names = missing.map((part) => labelOfPart(part).toLowerCase());
    complaint.textContent = missing.length > 0 ? `Still missing: ${names.join(', ')}.` : '';
    if (missing.length === 0) give(choices.bones);
  }
  choose(null);
  const { isShown, canForgetMap } = waiting;
  const why = isShown
    ? 'Does a limb move as it should not? Then a bone is mapped to the wrong part of the body.'
    : `The ${choices.joints.length} bones of ${waiting.name} could not be matched to a humanoid.`;
  const node = element(
    'section',
    { class: 'bones', tabindex: -1, 'aria-label': 'Bones of this file' },
    element('h2', {}, 'Bones of this file'),
    element(
      'p',
      { class: 'hint' },
      `${why} Choose a bone on the picture, then its part of the body. A tap among bones that are close together ` +
        'enlarges them. The page remembers the map for this file.',
    ),
    picture.node,
    bone,
    hint,
    element(
      'p',
      { class: 'hint' },
      `${choices.pairs.length > 0 ? 'Seen from the front: its left is on the right. ' : ''}Orange bones are guesses, ` +
        'grey bones are no part of the body, red parts are missing.',
    ),
    ...listed.map(({ node }) => node),
    complaint,
    button('Use these bones', submit, { class: 'primary' }),
    ...(canForgetMap ? [button('Forget my map', () => give(null))] : []),
    ...(isShown ? [button('Cancel', cancel)] : []),
  );
  return { node, complaint };
}

/** Lets the user map the bones of the file that waits for it, one file after another. */
export function createBonesForm(actions: BonesActions) {
  const node = element('div', {});
  let mapping: ReturnType<typeof createMapping> | null = null;
  let shown: WaitingForBones | null = null;
  return {
    node,
    show(waiting: WaitingForBones | null) {
      if (waiting?.joints !== shown?.joints) {
        mapping = waiting && createMapping(waiting, actions);
        node.replaceChildren(...(mapping ? [mapping.node] : []));
        // The user has asked for the form: it is below the button that opens it, or far below on a small screen.
        if (waiting?.isShown) mapping?.node.focus();
      }
      // The page's complaint about a map that was given.
      if (mapping && waiting?.complaint !== shown?.complaint) mapping.complaint.textContent = waiting?.complaint ?? '';
      shown = waiting;
    },
  };
}
