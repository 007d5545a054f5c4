import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import type { BoneMap, BoneName } from 'threepoint/core';
import { Button, Group } from 'threepoint-ui/controls';
import { BoneChoices, isNeeded, labelOfPart, partGroups } from './bone-choices';
import { SkeletonPicture } from './skeleton-picture';
import type { SkeletonToMap } from './skeleton-to-map';
import { SkeletonView } from './skeleton-view';
import './bones-form.css';

/** Fingers, eyes and jaw are listed once a bone is one of them. */
const alwaysListed = 5;

/** What the form does with the user's map. */
export interface BonesActions {
  /** null: forgets the user's map. */
  readonly apply: (bones: BoneMap | null) => void;
  readonly cancel: () => void;
}

interface PartsProps {
  readonly choices: BoneChoices;
  readonly chosen: BoneName | null;
  readonly onChoose: (part: BoneName) => void;
}

/** Lists the parts of a body, with the bone that each one is. */
const Parts = ({ choices, chosen, onChoose }: PartsProps) =>
  partGroups.map(({ label, parts }, group) => {
    const isAlways = (part: BoneName) => group < alwaysListed && (isNeeded(part) || !/Eye$|^jaw$|Toes$/.test(part));
    const listed = parts.filter(([part]) => choices.jointOf(part) >= 0 || isAlways(part));
    if (listed.length === 0) return null;
    return (
      <Group key={label} label={label} class="parts">
        <span aria-hidden>{label}</span>
        {listed.map(([part]) => {
          const joint = choices.jointOf(part);
          const [look, missing] = isNeeded(part) ? ['missing', 'missing'] : ['none', 'not mapped'];
          const title = joint < 0 ? missing : choices.fileNameOf(joint);
          return (
            <Button
              key={part}
              // The group has the side.
              label={labelOfPart(part).replace(/^(Left|Right) (?!eye)/, '')}
              class={joint < 0 ? look : choices.isUnsure(joint) ? 'unsure' : 'sure'}
              title={title}
              aria-label={`${labelOfPart(part)}: ${title}`}
              aria-pressed={part === chosen}
              onClick={() => onChoose(part)}
            />
          );
        })}
      </Group>
    );
  });

interface PartSelectProps {
  readonly chosen: BoneName | null;
  readonly onChoose: (part: BoneName | null) => void;
}

/** Lets the user choose the part of the body that one bone is. */
const PartSelect = ({ chosen, onChoose }: PartSelectProps) => (
  <select
    value={chosen ?? ''}
    onChange={({ currentTarget: { value } }) => onChoose(value === '' ? null : (value as BoneName))}
  >
    <option value="">no part of the body</option>
    {partGroups.map(({ label, parts }) => (
      <optgroup key={label} label={label}>
        {parts.map(([value, text]) => (
          <option key={value} value={value}>
            {text}
          </option>
        ))}
      </optgroup>
    ))}
  </select>
);

/** Lets the user choose a bone and its part of the body, or first a part and then its bone, by picture and list. */
function Chooser({ choices }: { readonly choices: BoneChoices }) {
  const [view] = useState(() => new SkeletonView(choices.joints, choices.pairs));
  /** `part`: the part whose bone the user chooses next; null: a bone was chosen first. */
  const [{ bone, part }, select] = useState<{ readonly bone: number | null; readonly part: BoneName | null }>({
    bone: null,
    part: null,
  });
  const picture = useRef<HTMLDivElement>(null);

  function choose(joint: number | null, partToAssign: BoneName | null = null): void {
    // A picture that was zoomed stays where it is.
    if (joint !== null && joint !== bone) view.reveal(joint);
    select({ bone: joint, part: partToAssign });
  }

  function chooseBone(joint: number): void {
    if (part) choices.assign(joint, part);
    choose(joint);
  }

  function choosePart(chosen: BoneName): void {
    const joint = choices.jointOf(chosen);
    choose(joint < 0 ? null : joint, joint < 0 ? chosen : null);
    picture.current?.scrollIntoView({ block: 'nearest' });
  }

  function assign(joint: number, chosen: BoneName | null): void {
    choices.assign(joint, chosen);
    choose(joint);
  }

  return (
    <>
      <div ref={picture}>
        <SkeletonPicture
          choices={choices}
          view={view}
          chosen={bone}
          onChoose={chooseBone}
          onZoom={() => select({ bone, part })}
        />
      </div>
      {bone !== null && (
        <label class="bone">
          <span>{`${choices.fileNameOf(bone)} is`}</span>
          <PartSelect chosen={choices.partOf(bone)} onChoose={(chosen) => assign(bone, chosen)} />
        </label>
      )}
      <p class="hint" role="status">
        {part && `Choose the bone of the ${labelOfPart(part).toLowerCase()} on the picture.`}
      </p>
      <p class="hint">
        {choices.pairs.length > 0 && 'Seen from the front: its left is on the right. '}
        Orange bones are guesses, grey bones are no part of the body, red parts are missing.
      </p>
      <Parts choices={choices} chosen={bone === null ? part : choices.partOf(bone)} onChoose={choosePart} />
    </>
  );
}

/** The form in which the user maps the bones of one file. */
export function BonesForm({ skeleton, apply, cancel }: BonesActions & { readonly skeleton: SkeletonToMap }) {
  const [choices] = useState(() => new BoneChoices(skeleton));
  const [missing, setMissing] = useState('');
  const section = useRef<HTMLElement>(null);
  // The form lies below the button that opens it, far below on a small screen.
  useLayoutEffect(() => section.current?.focus(), []);
  function submit(): void {
    const names = choices.missing.map((part) => labelOfPart(part).toLowerCase());
    setMissing(names.length > 0 ? `Still missing: ${names.join(', ')}.` : '');
    if (names.length === 0) apply(choices.bones);
  }
  const reason = skeleton.isShown
    ? 'If a limb moves wrongly, a bone is mapped to the wrong part of the body.'
    : `The ${skeleton.joints.length} bones of ${skeleton.name} could not be matched to a humanoid.`;
  return (
    <section ref={section} class="bones" tabIndex={-1} aria-label="Bones of this file">
      <h2>Bones of this file</h2>
      <p class="hint">
        {`${reason} Choose a bone on the picture, then its part of the body. A tap among bones that are close together `}
        enlarges them. The page remembers the map for this file.
      </p>
      <Chooser choices={choices} />
      {/* The page complains about the user's map. */}
      <p class="complaint" role="alert">
        {missing || skeleton.complaint}
      </p>
      <Button label="Use these bones" class="primary" onClick={submit} />
      {skeleton.canForgetMap && <Button label="Forget my map" onClick={() => apply(null)} />}
      <Button label="Cancel" onClick={cancel} />
    </section>
  );
}
