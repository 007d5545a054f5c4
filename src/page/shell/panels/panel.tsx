import { useRef, useState } from 'preact/hooks';
import { useEscape } from 'threepoint-ui';
import { Button } from 'threepoint-ui/controls';
import { AvatarPage } from './avatar-page';
import { BodyPage } from './body-page';
import type { PanelPageProps } from './panel-actions';
import { exitLabel } from './panel-state';
import { RecordingPage } from './recording-page';
import { ViewPage } from './view-page';

const pages = [
  { name: 'Body', Page: BodyPage },
  { name: 'Avatar', Page: AvatarPage },
  { name: 'Recording', Page: RecordingPage },
  { name: 'View', Page: ViewPage },
] as const;

/** The steps of the arrow keys through the tabs. */
const arrowSteps: Readonly<Record<string, number>> = { ArrowRight: 1, ArrowLeft: -1 };

/** Tabs after the ARIA pattern: one tab is in the tab order, and arrow keys move between them. */
function Tabs(props: PanelPageProps) {
  const [chosen, choose] = useState(0);
  const list = useRef<HTMLDivElement>(null);
  const onKeyDown = (event: KeyboardEvent) => {
    const step = arrowSteps[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const next = (chosen + step + pages.length) % pages.length;
    choose(next);
    list.current?.querySelectorAll('button')[next]?.focus();
  };
  return (
    <>
      <div ref={list} role="tablist" aria-label="Controls" onKeyDown={onKeyDown}>
        {pages.map(({ name }, index) => (
          <Button
            label={name}
            role="tab"
            id={`tab-${name}`}
            aria-controls={`page-${name}`}
            aria-selected={index === chosen}
            tabIndex={index === chosen ? 0 : -1}
            onClick={() => choose(index)}
          />
        ))}
      </div>
      {pages.map(({ name, Page }, index) => (
        <div role="tabpanel" id={`page-${name}`} aria-labelledby={`tab-${name}`} class="page" hidden={index !== chosen}>
          <Page {...props} />
        </div>
      ))}
    </>
  );
}

/** The controls of the desktop page, a page behind each tab. `toggle` opens or closes them. */
export function Panel({
  state,
  actions,
  open,
  toggle,
}: PanelPageProps & { readonly open: boolean; readonly toggle: () => void }) {
  const opener = useRef<HTMLButtonElement>(null);
  const panel = useRef<HTMLDivElement>(null);
  useEscape(open, () => {
    if (panel.current?.contains(document.activeElement)) opener.current?.focus();
    toggle();
  });
  return (
    <>
      <div class="panel-bar">
        <Button
          label={exitLabel(state.inPassthrough)}
          class="quiet"
          hidden={!state.inSession}
          onClick={() => actions.exitVr()}
        />
        <Button label="Centre" class="quiet" onClick={() => actions.recentre()} />
        <button
          type="button"
          ref={opener}
          class="quiet opener"
          aria-controls="panel"
          aria-expanded={open}
          onClick={toggle}
        >
          Controls
        </button>
      </div>
      <div ref={panel} class="panel" id="panel" hidden={!open}>
        <Tabs state={state} actions={actions} />
      </div>
    </>
  );
}
