import './input-dialog.css';
import { useSignal } from '@preact/signals';
import { type ComponentChildren, render } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { Button, Labelled } from 'threepoint-ui/controls';

interface InputDialog {
  readonly title: string;
  /** The label of the confirming button. */
  readonly confirm: string;
  /** The label of a field for a sentence. The dialog cannot be confirmed without the sentence. */
  readonly sentence?: string;
  /** Further content, with named fields. */
  readonly content?: ComponentChildren;
}

type Answer = (fields: FormData | null) => void;

function Dialog({ title, confirm, sentence, content, answer }: InputDialog & { readonly answer: Answer }) {
  const dialog = useRef<HTMLDialogElement>(null);
  const form = useRef<HTMLFormElement>(null);
  const incomplete = useSignal(sentence !== undefined);
  useLayoutEffect(() => dialog.current?.showModal(), []);
  const close = () => answer(dialog.current?.returnValue && form.current ? new FormData(form.current) : null);
  return (
    <dialog ref={dialog} aria-label={title} onClose={close}>
      <form ref={form} method="dialog" noValidate>
        <h2 style="margin:0">{title}</h2>
        {sentence !== undefined && (
          <Labelled label={sentence}>
            <textarea
              name="sentence"
              maxlength={500}
              aria-label={sentence}
              onInput={({ currentTarget }) => {
                incomplete.value = currentTarget.value.trim() === '';
              }}
            />
          </Labelled>
        )}
        {content}
        <div class="bar">
          <button type="submit" class="primary" value="confirmed" disabled={incomplete}>
            {confirm}
          </button>
          <Button label="Cancel" onClick={() => dialog.current?.close()} />
        </div>
      </form>
    </dialog>
  );
}

/** Opens a dialog; resolves with its fields, or with null if it is cancelled. */
export function askInDialog(question: InputDialog): Promise<FormData | null> {
  const place = document.body.appendChild(document.createElement('div'));
  return new Promise((resolve) => {
    const answer: Answer = (fields) => {
      resolve(fields);
      render(null, place);
      place.remove();
    };
    render(<Dialog {...question} answer={answer} />, place);
  });
}

export const sentenceOf = (fields: FormData): string => String(fields.get('sentence')).trim();
