import { render } from 'preact';
import { Button } from './controls';

interface EnterButtonState {
  readonly label: string;
  /** The label of the second button, which enters a session that shows the room around the user; null: none. */
  readonly passthroughLabel: string | null;
  readonly sentence: string | null;
  readonly enabled: boolean;
}

/** The big button of the page, and beside it the one for passthrough. */
export function createEnterButton(region: HTMLElement, onEnter: (passthrough: boolean) => void) {
  const show = ({ label, passthroughLabel, sentence, enabled }: EnterButtonState): void =>
    render(
      <>
        <div>
          <Button label={label} class="enter" disabled={!enabled} onClick={() => onEnter(false)} />
          <Button
            label={passthroughLabel ?? ''}
            class="enter-ar"
            hidden={passthroughLabel === null}
            onClick={() => onEnter(true)}
          />
        </div>
        <p class="sentence" role="status" hidden={sentence === null}>
          {sentence}
        </p>
      </>,
      region,
    );
  show({ label: 'Enter VR', passthroughLabel: null, sentence: null, enabled: false });
  return { show };
}

export type EnterButton = ReturnType<typeof createEnterButton>;
