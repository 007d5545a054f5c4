import { defaultAvatar, skinTones } from 'threepoint/core';
import { bodyLabels, skinColors } from 'threepoint/three';
import { button, createStatusLine, element, fileButton, toggle } from 'threepoint-ui';
import { createLazyBonesForm } from '../../bones/lazy-bones-form';
import type { PanelActions } from './panel-actions';
import type { PanelPage, PanelState } from './panel-state';

export interface PaletteChoice {
  readonly name: string;
  readonly label: string;
  readonly color: string;
}

/** Shows the name of the avatar and, for built-in avatars, their colours. `correct`: what corrects a file's bones. */
function createShown(palettes: readonly PaletteChoice[], actions: PanelActions, correct: HTMLElement) {
  const name = element('p', { class: 'avatar-name' });
  const pending = createStatusLine({ class: 'hint' });
  const builtIn = button('Back to the page’s avatar', () => actions.showBuiltInAvatar());
  const cancel = button('Cancel loading', () => actions.cancelAvatar());
  const bodies = bodyLabels.map((body) => ({
    name: body.name,
    node: button(body.label, () => actions.chooseBuiltInBody(body.name)),
  }));
  const swatch = (label: string, color: string, act: () => void): HTMLButtonElement => {
    const node = button('', act, { class: 'swatch', 'aria-label': label, title: label });
    node.style.setProperty('--swatch', color);
    return node;
  };
  const colours = palettes.map(({ name: palette, label, color }) => ({
    palette,
    node: swatch(label, color, () => actions.choosePalette(palette)),
  }));
  const tones = skinTones.map((tone) => ({
    tone,
    node: swatch(`Skin: ${tone}`, skinColors[tone], () => actions.chooseSkinTone(tone)),
  }));
  const row = (label: string, all: readonly { readonly node: HTMLElement }[]) =>
    element('div', { class: 'swatches', role: 'group', 'aria-label': label }, ...all.map(({ node }) => node));
  return {
    node: element(
      'section',
      {},
      element('h2', {}, 'Avatar'),
      name,
      pending.node,
      cancel,
      element('div', { class: 'chips', role: 'group', 'aria-label': 'Our bodies' }, ...bodies.map(({ node }) => node)),
      row('Colours', colours),
      row('Skin', tones),
      builtIn,
      correct,
    ),
    show({
      avatarName,
      avatarPending,
      avatarOnItsWay,
      builtInAvatarOffered,
      builtInBody,
      skinTone,
      palette: worn,
    }: PanelState) {
      name.textContent = avatarName;
      pending.show(avatarPending ?? '');
      pending.node.hidden = avatarPending === null;
      builtIn.hidden = !builtInAvatarOffered;
      cancel.hidden = !avatarOnItsWay;
      for (const { name, node } of bodies) node.setAttribute('aria-pressed', String(name === builtInBody));
      for (const { palette, node } of colours) {
        node.setAttribute('aria-pressed', String(palette === worn));
        node.disabled = worn === null;
      }
      for (const { tone, node } of tones) {
        node.setAttribute('aria-pressed', String(tone === skinTone));
        node.disabled = builtInBody === null || builtInBody === defaultAvatar;
      }
    },
  };
}

/** Lets the user open another avatar: a file of this device, or an address. */
function otherAvatars(actions: PanelActions): HTMLElement {
  const address = element('input', {
    type: 'url',
    placeholder: 'https://…/avatar.vrm',
    'aria-label': 'Address of a VRM, GLB or FBX',
  });
  const form = element('form', { class: 'row' }, address, element('button', { type: 'submit' }, 'Load'));
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    if (address.value) actions.openAvatarUrl(address.value);
  });
  return element(
    'section',
    {},
    element('h2', {}, 'Another one'),
    element(
      'p',
      { class: 'hint' },
      'Any VRM (0.x or 1.0), or a humanoid as GLB or FBX (Mixamo, Ready Player Me, Avaturn, VRoid, Unreal, Rigify, Character Creator): drop it on the page, or',
    ),
    element(
      'div',
      { class: 'row' },
      ...fileButton('Open VRM, GLB or FBX', '.vrm,.glb,.fbx', ([file]) => actions.openAvatarFile(file)),
    ),
    form,
  );
}

/** Shows the form for the bones of a file, and the button that opens it for the shown avatar. */
function createBones(actions: PanelActions) {
  const form = createLazyBonesForm({ apply: (map) => actions.applyBones(map), cancel: () => actions.cancelAvatar() });
  const correct = button('Correct the bones…', () => actions.correctBones());
  return {
    node: form.node,
    correct,
    show({ waitingForBones, canCorrectBones }: PanelState) {
      const hadFocus = form.node.contains(document.activeElement);
      correct.hidden = !canCorrectBones;
      form.show(waitingForBones);
      if (hadFocus && !waitingForBones && canCorrectBones) correct.focus();
    },
  };
}

/** Which avatars players show to each other. */
function createSight(actions: PanelActions) {
  const share = toggle('Others see my avatar', (shareAvatar) => actions.keep({ shareAvatar }));
  const plain = toggle('Show all others as mannequins', (plainOthers) => actions.keep({ plainOthers }));
  return {
    node: element(
      'section',
      {},
      element('h2', {}, 'In shared rooms'),
      share.node,
      element(
        'p',
        { class: 'hint' },
        'The file may have up to 20 MB. The server keeps it for the people in the room until you leave. In a study all avatars are alike.',
      ),
      plain.node,
    ),
    show({ shareAvatar, plainOthers }: PanelState) {
      share.input.checked = shareAvatar;
      plain.input.checked = plainOthers;
    },
  };
}

/** Which avatar the body wears, and how much of it. */
export function createAvatarPage(palettes: readonly PaletteChoice[], actions: PanelActions): PanelPage {
  const bones = createBones(actions);
  const shown = createShown(palettes, actions, bones.correct);
  const sight = createSight(actions);
  const upperBody = toggle('Upper body only', (upperBodyOnly) => actions.keep({ upperBodyOnly }));
  return {
    name: 'Avatar',
    content: [shown.node, bones.node, otherAvatars(actions), sight.node, element('section', {}, upperBody.node)],
    show(state) {
      shown.show(state);
      bones.show(state);
      sight.show(state);
      upperBody.input.checked = state.upperBodyOnly;
    },
  };
}
