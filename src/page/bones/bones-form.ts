import type { BoneMap, BoneName } from 'threepoint/core';
import { button, element } from 'threepoint-ui';
import { BoneChoices, isNeeded, labelOfPart, partGroups } from './bone-choices';
import { createSkeletonPicture } from './skeleton-picture';
import type { SkeletonToMap } from './skeleton-to-map';
import './bones-form.css';

/** Fingers, eyes and jaw are listed once a bone is one of them. */
const alwaysListed = 5;

/** What the form does with the user's map. */
export interface BonesActions {
  /** null: forgets the user's map. */
  apply(bones: BoneMap | null): void;
  cancel(): void;
}

/** Lists the parts of a body, with the bone that each one is. */
function createPartList(choices: BoneChoices, onChoose: (part: BoneName) => void) {
  const groups = partGroups.map(({ label, parts }, group) => {
    const rows = parts.map(([part]) => ({
      part,
      always: group < alwaysListed && (isNeeded(part) || !/Eye$|^jaw$|Toes$/.test(part)),
      // The group has the side.
      node: button(labelOfPart(part).replace(/^(Left|Right) (?!eye)/, ''), () => onChoose(part)),
    }));
    const node = element(
      'div',
      { class: 'parts', role: 'group', 'aria-label': label },
      element('span', { 'aria-hidden': 'true' }, label),
      ...rows.map(({ node }) => node),
    );
    return { node, rows };
  });
  return {
    nodes: groups.map(({ node }) => node),
    show(chosen: BoneName | null): void {
      for (const { node, rows } of groups) {
        for (const { part, always, node } of rows) {
          const joint = choices.jointOf(part);
          node.hidden = joint < 0 && !always;
          node.title = joint < 0 ? (isNeeded(part) ? 'missing' : 'not mapped') : choices.fileNameOf(joint);
          node.className =
            joint < 0 ? (isNeeded(part) ? 'missing' : 'none') : choices.isUnsure(joint) ? 'unsure' : 'sure';
          node.setAttribute('aria-label', `${labelOfPart(part)}: ${node.title}`);
          node.setAttribute('aria-pressed', String(part === chosen));
        }
        node.hidden = rows.every(({ node }) => node.hidden);
      }
    },
  };
}

/** Lets the user choose the part of the body that one bone is. */
function createPartSelect(onChoose: (part: BoneName | null) => void) {
  const name = element('span', {});
  const groups = partGroups.map(({ label, parts }) =>
    element('optgroup', { label }, ...parts.map(([part, label]) => element('option', { value: part }, label))),
  );
  const select = element('select', {}, element('option', { value: '' }, 'no part of the body'), ...groups);
  select.addEventListener('change', () => onChoose(select.value === '' ? null : (select.value as BoneName)));
  const node = element('label', { class: 'bone' }, name, select);
  return {
    node,
    show(bone: string | null, part: BoneName | null): void {
      node.hidden = bone === null;
      name.textContent = bone === null ? '' : `${bone} is`;
      select.value = part ?? '';
    },
  };
}

/** Lets the user choose a bone and its part of the body, or first a part and then its bone, by picture and list. */
function createChooser(choices: BoneChoices) {
  let chosenBone: number | null = null;
  /** The part whose bone the user chooses next; null: a bone was chosen first. */
  let partToAssign: BoneName | null = null;
  const picture = createSkeletonPicture(choices, (joint) => {
    if (partToAssign) choices.assign(joint, partToAssign);
    choose(joint);
  });
  const partOfBone = createPartSelect((part) => {
    if (chosenBone !== null) choices.assign(chosenBone, part);
    choose(chosenBone);
  });
  const list = createPartList(choices, (part) => {
    const joint = choices.jointOf(part);
    choose(joint < 0 ? null : joint, joint < 0 ? part : null);
    picture.node.scrollIntoView({ block: 'nearest' });
  });
  const hint = element('p', { class: 'hint', role: 'status' });

  function choose(joint: number | null, part: BoneName | null = null): void {
    chosenBone = joint;
    partToAssign = part;
    const current = joint === null ? null : choices.partOf(joint);
    picture.show(joint);
    partOfBone.show(joint === null ? null : choices.fileNameOf(joint), current);
    list.show(current ?? part);
    hint.textContent = part ? `Choose the bone of the ${labelOfPart(part).toLowerCase()} on the picture.` : '';
  }

  choose(null);
  const colours = element(
    'p',
    { class: 'hint' },
    `${choices.pairs.length > 0 ? 'Seen from the front: its left is on the right. ' : ''}Orange bones are guesses, ` +
      'grey bones are no part of the body, red parts are missing.',
  );
  return [picture.node, partOfBone.node, hint, colours, ...list.nodes];
}

/** Lets the user map the bones of one file. */
function createMapping(skeleton: SkeletonToMap, { apply: give, cancel }: BonesActions) {
  const { name, joints, isShown, canForgetMap } = skeleton;
  const choices = new BoneChoices(skeleton);
  const complaint = element('p', { class: 'complaint', role: 'alert' });
  function submit(): void {
    const { missing } = choices;
    const names = missing.map((part) => labelOfPart(part).toLowerCase());
    complaint.textContent = missing.length > 0 ? `Still missing: ${names.join(', ')}.` : '';
    if (missing.length === 0) give(choices.bones);
  }
  const reason = isShown
    ? 'Does a limb move as it should not? Then a bone is mapped to the wrong part of the body.'
    : `The ${joints.length} bones of ${name} could not be matched to a humanoid.`;
  const node = element(
    'section',
    { class: 'bones', tabindex: -1, 'aria-label': 'Bones of this file' },
    element('h2', {}, 'Bones of this file'),
    element(
      'p',
      { class: 'hint' },
      `${reason} Choose a bone on the picture, then its part of the body. A tap among bones that are close together ` +
        'enlarges them. The page remembers the map for this file.',
    ),
    ...createChooser(choices),
    complaint,
    button('Use these bones', submit, { class: 'primary' }),
    ...(canForgetMap ? [button('Forget my map', () => give(null))] : []),
    button('Cancel', cancel),
  );
  return { node, complaint };
}

/** Creates the form in which the user maps the bones of one file after another. */
export function createBonesForm(actions: BonesActions) {
  const node = element('div', {});
  let mapping: ReturnType<typeof createMapping> | null = null;
  let shown: SkeletonToMap | null = null;
  return {
    node,
    show(skeleton: SkeletonToMap | null) {
      if (skeleton?.joints !== shown?.joints) {
        mapping = skeleton && createMapping(skeleton, actions);
        node.replaceChildren(...(mapping ? [mapping.node] : []));
        // The form lies below the button that opens it, far below on a small screen.
        mapping?.node.focus();
      }
      // The page complains about the user's map.
      if (mapping && skeleton?.complaint !== shown?.complaint)
        mapping.complaint.textContent = skeleton?.complaint ?? '';
      shown = skeleton;
    },
  };
}
