import { childrenOf } from 'threepoint/math';
import { Button } from 'threepoint-ui/controls';
import { type BoneChoices, isNeeded, labelOfPart } from './bone-choices';
import { pictureSize, type SkeletonView } from './skeleton-view';

/** The steps of the arrow keys through the list of bones. */
const arrowSteps: Readonly<Record<string, number>> = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 };

/** Returns the index in a list of this length that a key selects, from the current index; null: another key. */
function indexForKey(key: string, current: number, length: number): number | null {
  if (key === 'Home') return 0;
  if (key === 'End') return length - 1;
  const step = arrowSteps[key];
  return step === undefined ? null : Math.min(Math.max(current + step, 0), length - 1);
}

interface SkeletonPictureProps {
  readonly choices: BoneChoices;
  readonly view: SkeletonView;
  readonly chosen: number | null;
  readonly onChoose: (joint: number) => void;
  /** The picture was zoomed. */
  readonly onZoom: () => void;
}

/** Draws a skeleton as a list of its bones. A tap or the arrow keys choose one. */
export function SkeletonPicture({ choices, view, chosen, onChoose, onZoom }: SkeletonPictureProps) {
  const { joints } = choices;
  const selectable = joints.flatMap((_, joint) => (choices.canChoose(joint) ? [joint] : []));
  const tabStop = chosen ?? selectable[0];
  // A bone reaches from its joint to the next ones.
  const ends = childrenOf(joints.map(({ parent }) => parent));

  function choose(joint: number, picture: SVGSVGElement): void {
    onChoose(joint);
    (picture.children[joint] as SVGGElement).focus({ preventScroll: true });
  }

  function onClick({ clientX, clientY, target, detail, currentTarget }: MouseEvent): void {
    const picture = currentTarget as SVGSVGElement;
    const clicked = [...picture.children].findIndex((bone) => bone.contains(target as Node));
    // A click without a pointer, as from a screen reader, has no position.
    if (detail === 0 && clicked >= 0) {
      choose(clicked, picture);
      return;
    }
    const { left, top, width } = picture.getBoundingClientRect();
    const scale = pictureSize / width;
    const joint = view.pick({ x: (clientX - left) * scale, y: (clientY - top) * scale }, selectable, chosen);
    if (joint === null) onZoom();
    else choose(joint, picture);
  }

  function onKeyDown(event: KeyboardEvent): void {
    const current = chosen === null ? -1 : selectable.indexOf(chosen);
    const next = indexForKey(event.key, current, selectable.length);
    if (next === null) return;
    event.preventDefault();
    const joint = selectable[next];
    if (joint !== undefined) choose(joint, event.currentTarget as SVGSVGElement);
  }

  function showWhole(): void {
    view.showWhole();
    onZoom();
  }

  /** Draws one bone: a dot at its joint and lines to the next joints. */
  function drawBone(joint: number) {
    const { x, y } = view.place(joint);
    const part = choices.partOf(joint);
    const isUnsure = choices.isUnsure(joint);
    const state = part === null ? 'none' : isUnsure ? 'unsure' : 'sure';
    const label = part ? `${labelOfPart(part)}${isUnsure ? ', a guess' : ''}` : 'no part of the body';
    const option = {
      role: 'option',
      'aria-label': `${choices.fileNameOf(joint)}: ${label}`,
      'aria-selected': joint === chosen,
      tabindex: joint === tabStop ? 0 : -1,
    } as const;
    const lines = ends[joint]!.map((end) => view.place(end)).map((end) => `M${x} ${y}L${end.x} ${end.y}`);
    return (
      <g
        class={[state, part && isNeeded(part) && 'needed', joint === chosen && 'chosen'].filter(Boolean).join(' ')}
        {...(choices.canChoose(joint) ? option : { 'aria-hidden': true })}
      >
        <path d={lines.join('')} />
        <circle r={4} cx={x} cy={y} />
      </g>
    );
  }

  return (
    <div class="skeleton">
      <svg
        viewBox={`0 0 ${pictureSize} ${pictureSize}`}
        // biome-ignore lint/a11y/noNoninteractiveElementToInteractiveRole: its bones are a list
        role="listbox"
        aria-label="Bones of the file"
        onClick={onClick}
        onKeyDown={onKeyDown}
      >
        {joints.map((_, joint) => drawBone(joint))}
      </svg>
      <Button label="Whole body" class="quiet" hidden={!view.isZoomed} onClick={showWhole} />
    </div>
  );
}
