import type { ButtonHTMLAttributes, ComponentChildren, InputHTMLAttributes } from 'preact';

/** A button that cannot submit anything. */
export const Button = ({ label, ...attributes }: ButtonHTMLAttributes & { readonly label: string }) => (
  <button type="button" {...attributes}>
    {label}
  </button>
);

/** A complaint that screen readers announce at once; nothing without a text. */
export const Complaint = ({ text }: { readonly text: string | null }) => (
  <p class="complaint" role="alert" hidden={!text}>
    {text}
  </p>
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
      {choices.map(({ id, label }) => (
        <option key={id} value={id}>
          {label}
        </option>
      ))}
    </select>
  </Labelled>
);

interface FileFieldProps {
  readonly label: string;
  /** The accessible name. */
  readonly name: string;
  /** The accepted types, as in HTML. */
  readonly accept: string;
  readonly open: (file: File) => void;
}

export const FileField = ({ label, name, accept, open }: FileFieldProps) => (
  <Labelled label={label}>
    <input
      type="file"
      accept={accept}
      aria-label={name}
      onChange={({ currentTarget }) => {
        const [chosen] = currentTarget.files ?? [];
        if (chosen) open(chosen);
        // Choosing the same file again must emit a change too.
        currentTarget.value = '';
      }}
    />
  </Labelled>
);

interface TickProps extends Pick<InputHTMLAttributes, 'name' | 'checked' | 'defaultChecked' | 'onChange'> {
  readonly label: string;
}

/** A checkbox with its label after it, in a line. */
export const Tick = ({ label, ...input }: TickProps) => (
  <label class="inline">
    <input type="checkbox" {...input} />
    <span>{label}</span>
  </label>
);
