import { useRef } from 'preact/hooks';
import { defaultAvatar, skinTones } from 'threepoint/core';
import { bodyLabels, palettes, skinColors } from 'threepoint/internal/three';
import { Button, FileButton, Group, StatusLine, Toggle } from 'threepoint-ui/controls';
import { LazyBonesForm } from '../../bones/lazy-bones-form';
import { ownColours } from '../session/settings';
import type { PanelPageProps } from './panel-actions';

interface SwatchesProps<Name extends string> {
  readonly title: string;
  readonly looks: readonly { readonly name: Name; readonly label: string; readonly color: string }[];
  readonly chosen: string | undefined;
  readonly disabled: boolean;
  readonly choose: (name: Name) => void;
}

/** Lets the user choose a colour, and names the chosen one. */
const Swatches = <Name extends string>({ title, looks, chosen, disabled, choose }: SwatchesProps<Name>) => (
  <Group label={title} class="swatches">
    <p class="hint">{`${title}: ${looks.find(({ name }) => name === chosen)?.label ?? ownLook.label}`}</p>
    {looks.map(({ name, label, color }) => (
      <Button
        label=""
        class="swatch"
        aria-label={`${title}: ${label}`}
        title={label}
        aria-pressed={name === chosen}
        disabled={disabled}
        style={{ '--swatch': color }}
        onClick={() => choose(name)}
      />
    ))}
  </Group>
);

const ownLook = {
  name: ownColours,
  label: 'its own',
  color: 'linear-gradient(135deg, #1d9a86 50%, #2c3350 50%)',
} as const;
const clothes = [ownLook, ...palettes.map((palette) => ({ ...palette, label: palette.label.toLowerCase() }))];
const skins = [ownLook, ...skinTones.map((name) => ({ name, label: name, color: skinColors[name] }))];

/** Shows the current avatar: its name, its colours if it is built in, and the bones of a file. */
function ShownAvatar({ state, actions }: PanelPageProps) {
  const correct = useRef<HTMLButtonElement>(null);
  const { builtInBody, palette: worn } = state;
  return (
    <>
      <section>
        <h2>Avatar</h2>
        <p class="avatar-name">{state.avatarName}</p>
        <StatusLine class="hint" words={state.avatarPending ?? ''} hidden={state.avatarPending === null} />
        {state.avatarOnItsWay && <Button label="Cancel loading" onClick={() => actions.cancelAvatar()} />}
        <Group label="Our bodies" class="chips">
          {bodyLabels.map(({ name, label }) => (
            <Button label={label} aria-pressed={name === builtInBody} onClick={() => actions.chooseBuiltInBody(name)} />
          ))}
        </Group>
        <Swatches
          title="Clothes"
          looks={clothes}
          chosen={worn ?? undefined}
          disabled={worn === null}
          choose={(name) => actions.choosePalette(name)}
        />
        <Swatches
          title="Skin"
          looks={skins}
          chosen={state.skinTone ?? ownColours}
          disabled={builtInBody === null || builtInBody === defaultAvatar}
          choose={(tone) => actions.chooseSkinTone(tone === ownColours ? undefined : tone)}
        />
        {state.builtInAvatarOffered && (
          <Button label="Back to the page’s avatar" onClick={() => actions.showBuiltInAvatar()} />
        )}
        <button type="button" ref={correct} hidden={!state.canCorrectBones} onClick={() => actions.correctBones()}>
          Correct the bones…
        </button>
      </section>
      <LazyBonesForm
        skeleton={state.waitingForBones}
        opener={correct}
        apply={(map) => actions.applyBones(map)}
        cancel={() => actions.cancelAvatar()}
      />
    </>
  );
}

/** Lets the user open another avatar: a file of this device, or an address. */
function OtherAvatars({ actions }: Pick<PanelPageProps, 'actions'>) {
  const address = useRef<HTMLInputElement>(null);
  const onSubmit = (event: SubmitEvent) => {
    event.preventDefault();
    if (address.current?.value) actions.openAvatarUrl(address.current.value);
  };
  return (
    <section>
      <h2>Another avatar</h2>
      <p class="hint">
        Any VRM (0.x or 1.0), or a humanoid as GLB or FBX (Mixamo, Ready Player Me, Avaturn, VRoid, Unreal, Rigify,
        Character Creator). You can also drop it on the page.
      </p>
      <div class="row">
        <FileButton
          label="Open VRM, GLB or FBX"
          accept=".vrm,.glb,.gltf,.fbx"
          open={([file]) => actions.openAvatarFile(file)}
        />
      </div>
      <form class="row" onSubmit={onSubmit}>
        <input ref={address} type="url" placeholder="https://…/avatar.vrm" aria-label="Address of a VRM, GLB or FBX" />
        <button type="submit">Load</button>
      </form>
    </section>
  );
}

/** Which avatar the body wears, how much of it, and which avatars players show to each other. */
export const AvatarPage = ({ state, actions }: PanelPageProps) => (
  <>
    <ShownAvatar state={state} actions={actions} />
    <OtherAvatars actions={actions} />
    <section>
      <h2>In shared rooms</h2>
      <Toggle
        label="Others see my avatar"
        on={state.shareAvatar}
        set={(shareAvatar) => actions.keep({ shareAvatar })}
      />
      <p class="hint">
        The file may have up to 20 MB. The server stores it for the people in the room until you leave. In a study all
        avatars are alike.
      </p>
      <Toggle
        label="Show all others as mannequins"
        on={state.plainOthers}
        set={(plainOthers) => actions.keep({ plainOthers })}
      />
    </section>
    <section>
      <Toggle
        label="Upper body only"
        on={state.upperBodyOnly}
        set={(upperBodyOnly) => actions.keep({ upperBodyOnly })}
      />
    </section>
  </>
);
