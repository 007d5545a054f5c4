import { useRef } from 'preact/hooks';
import { defaultAvatar, skinTones } from 'threepoint/core';
import { bodyLabels, palettes, skinColors } from 'threepoint/internal/three';
import { Button, FileButton, Group, StatusLine, Toggle } from 'threepoint-ui/controls';
import { LazyBonesForm } from '../../bones/lazy-bones-form';
import { ownColours } from '../session/settings';
import type { PanelPageProps } from './panel-actions';

interface SwatchProps {
  readonly label: string;
  readonly color: string;
  readonly chosen: boolean;
  readonly disabled: boolean;
  readonly choose: () => void;
}

const Swatch = ({ label, color, chosen, disabled, choose }: SwatchProps) => (
  <Button
    label=""
    class="swatch"
    aria-label={label}
    title={label}
    aria-pressed={chosen}
    disabled={disabled}
    style={{ '--swatch': color }}
    onClick={choose}
  />
);

const ownLook = { name: ownColours, label: 'Its own', color: 'linear-gradient(135deg, #1d9a86 50%, #2c3350 50%)' };

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
        <Group label="Colours" class="swatches">
          {[ownLook, ...palettes].map(({ name, label, color }) => (
            <Swatch
              label={label}
              color={color}
              chosen={name === worn}
              disabled={worn === null}
              choose={() => actions.choosePalette(name)}
            />
          ))}
        </Group>
        <Group label="Skin" class="swatches">
          {skinTones.map((tone) => (
            <Swatch
              label={`Skin: ${tone}`}
              color={skinColors[tone]}
              chosen={tone === state.skinTone}
              disabled={builtInBody === null || builtInBody === defaultAvatar}
              choose={() => actions.chooseSkinTone(tone)}
            />
          ))}
        </Group>
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
      <h2>Another one</h2>
      <p class="hint">
        Any VRM (0.x or 1.0), or a humanoid as GLB or FBX (Mixamo, Ready Player Me, Avaturn, VRoid, Unreal, Rigify,
        Character Creator): drop it on the page, or
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
