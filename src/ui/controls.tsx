import type { ButtonHTMLAttributes, ComponentChildren, HTMLAttributes, InputHTMLAttributes } from 'preact';
import { useRef } from 'preact/hooks';

/** A button that cannot submit anything. */
export const Button = ({ label, ...attributes }: ButtonHTMLAttributes & { readonly label: string }) => (
  <button type="button" {...attributes}>
    {label}
  </button>
);

/** The `ref` of a dialog that is modal while it is rendered. Closing it returns the focus. */
export function openModal(dialog: HTMLDialogElement | null) {
  dialog?.showModal();
  return () => dialog?.close();
}

/** A complaint that screen readers announce at once; nothing without a text. */
export const Complaint = ({ text }: { readonly text: string | null }) => (
  <p class="complaint" role="alert" hidden={!text}>
    {text}
  </p>
);

interface StatusLineProps extends HTMLAttributes<HTMLParagraphElement> {
  readonly words: string;
  readonly figures?: string;
}

/** A line whose words are announced when they change. The running figures after them are only shown. */
export const StatusLine = ({ words, figures, ...attributes }: StatusLineProps) => (
  <p {...attributes}>
    <span role="status">{words}</span>
    <span>{figures}</span>
  </p>
);

interface GroupProps {
  readonly label: string;
  readonly class: string;
  readonly children: ComponentChildren;
}

/** A group with a name for screen readers. */
export const Group = ({ label, children, ...attributes }: GroupProps) => (
  // biome-ignore lint/a11y/useSemanticElements: a fieldset needs a visible legend, and cannot be a grid everywhere
  <div role="group" aria-label={label} {...attributes}>
    {children}
  </div>
);

export const Labelled = ({ label, children }: { readonly label: string; readonly children: ComponentChildren }) => (
  // biome-ignore lint/a11y/noLabelWithoutControl: the children are the control
  <label>
    <span>{label}</span>
    {children}
  </label>
);

/** An entry of a list. */
export interface Choice {
  readonly id: string;
  readonly label: string;
  readonly disabled?: boolean;
}

export interface ChooserProps {
  readonly name: string;
  readonly choices: readonly Choice[];
  /** The id of the chosen entry. undefined: the entry with the empty id. */
  readonly chosen: string | undefined;
  readonly choose: (id: string) => void;
}

export const Chooser = ({ name, choices, chosen = '', choose }: ChooserProps) => (
  <Labelled label={name}>
    <select
      aria-label={name}
      value={chosen}
      onChange={({ currentTarget }) => {
        const { value } = currentTarget;
        // The list shows the chosen entry, even if what follows from another choice fails.
        currentTarget.value = chosen;
        choose(value);
      }}
    >
      {choices.map(({ id, label, disabled }) => (
        <option key={id} value={id} disabled={disabled}>
          {label}
        </option>
      ))}
    </select>
  </Labelled>
);

interface ReplayTimelineProps {
  /** The accessible name of the slider. */
  readonly name: string;
  readonly paused: boolean;
  /** The position and the length [s]. */
  readonly seconds: number;
  readonly duration: number;
  readonly setPaused: (on: boolean) => void;
  readonly seek: (seconds: number) => void;
}

/** Plays and pauses a replay, shows its position and lets the user seek. */
export const ReplayTimeline = ({ name, paused, seconds, duration, setPaused, seek }: ReplayTimelineProps) => (
  <div class="timeline">
    <Button label={paused ? 'Play' : 'Pause'} onClick={() => setPaused(!paused)} />
    <input
      type="range"
      min={0}
      max={duration}
      step={0.01}
      aria-label={name}
      value={seconds}
      onInput={({ currentTarget }) => seek(currentTarget.valueAsNumber)}
    />
    <span class="time">{`${seconds.toFixed(1)} / ${duration.toFixed(1)} s`}</span>
  </div>
);

interface FileFieldProps {
  readonly label: string;
  /** The accessible name. */
  readonly name: string;
  /** The accepted types, as in HTML. */
  readonly accept: string;
  readonly open: (file: File) => void;
}

type Files = readonly [File, ...File[]];

/** Returns the listener of a file input, which passes the chosen files on. */
const passFiles =
  (open: (files: Files) => void) =>
  ({ currentTarget }: { readonly currentTarget: HTMLInputElement }) => {
    const [file, ...others] = currentTarget.files ?? [];
    if (file) open([file, ...others]);
    // Choosing the same file again must emit a change too.
    currentTarget.value = '';
  };

export const FileField = ({ label, name, accept, open }: FileFieldProps) => (
  <Labelled label={label}>
    <input type="file" accept={accept} aria-label={name} onChange={passFiles(([file]) => open(file))} />
  </Labelled>
);

interface FileButtonProps extends Pick<FileFieldProps, 'label' | 'accept'> {
  readonly multiple?: boolean;
  readonly open: (files: Files) => void;
}

/** A button that opens a file dialog for one file, or for several at once. */
export function FileButton({ label, accept, multiple, open }: FileButtonProps) {
  const input = useRef<HTMLInputElement>(null);
  const types = { accept, multiple, 'aria-label': label };
  return (
    <>
      <Button label={label} onClick={() => input.current?.click()} />
      <input ref={input} type="file" hidden {...types} onChange={passFiles(open)} />
    </>
  );
}

interface ToggleProps {
  readonly label: string;
  readonly on: boolean;
  readonly set: (on: boolean) => void;
  readonly disabled?: boolean;
}

/** A labelled switch; the whole row is its target. */
export const Toggle = ({ label, on, set, disabled }: ToggleProps) => (
  <label class="toggle">
    <span>{label}</span>
    <input
      type="checkbox"
      // biome-ignore lint/a11y/useAriaPropsForRole: a checkbox has its state
      role="switch"
      checked={on}
      disabled={disabled}
      onChange={({ currentTarget }) => set(currentTarget.checked)}
    />
  </label>
);

/** An input whose value does not change under the fingers of the user who types. */
export function TypedInput({ value, ...attributes }: InputHTMLAttributes & { readonly value: string }) {
  const input = useRef<HTMLInputElement>(null);
  const isTyped = input.current !== null && document.activeElement === input.current;
  return <input ref={input} value={isTyped ? undefined : value} {...attributes} />;
}

interface SentencesProps {
  readonly class: string;
  readonly sentences: readonly string[];
}

/** A list of sentences, such as the rules of a game. */
export const Sentences = ({ sentences, ...attributes }: SentencesProps) => (
  <ul {...attributes}>
    {sentences.map((sentence) => (
      <li>{sentence}</li>
    ))}
  </ul>
);

interface DetailsProps {
  /** What the details are about, such as "the methods"; it follows "Details of". */
  readonly of: string;
  /** Terms and their precise sentences. */
  readonly entries: readonly (readonly [term: string, sentence: string])[];
}

/** Precise sentences for researchers, folded away until they are opened. */
export const Details = ({ of, entries }: DetailsProps) => (
  <details class="details">
    <summary>Details of {of}</summary>
    <dl>
      {entries.map(([term, sentence]) => (
        <>
          <dt>{term}</dt>
          <dd>{sentence}</dd>
        </>
      ))}
    </dl>
  </details>
);

interface TickProps extends Pick<InputHTMLAttributes, 'name' | 'checked' | 'defaultChecked' | 'required' | 'onChange'> {
  readonly label: string;
}

/** A checkbox with its label after it, in a line. */
export const Tick = ({ label, ...input }: TickProps) => (
  <label class="inline">
    <input type="checkbox" {...input} />
    <span>{label}</span>
  </label>
);
