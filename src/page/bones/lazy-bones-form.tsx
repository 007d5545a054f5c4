import type { RefObject } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { firstLine, reasonOf } from 'threepoint/core';
import { useEscape } from 'threepoint-ui';
import { Complaint } from 'threepoint-ui/controls';
import type { BonesActions, BonesForm } from './bones-form';
import type { SkeletonToMap } from './skeleton-to-map';

interface LazyBonesFormProps extends BonesActions {
  /** The skeleton that waits for the user's map; null: none. */
  readonly skeleton: SkeletonToMap | null;
  /** The button that gets the focus back when the form closes. */
  readonly opener: RefObject<HTMLElement | null>;
}

/** Shows the form for the bones of a file. Its code is loaded once a file waits for them. */
export function LazyBonesForm({ skeleton, opener, ...actions }: LazyBonesFormProps) {
  const [loaded, setLoaded] = useState<{ readonly Form: typeof BonesForm } | null>(null);
  const [complaint, setComplaint] = useState<string | null>(null);
  const region = useRef<HTMLDivElement>(null);
  const isWaiting = skeleton !== null;
  useEscape(isWaiting, actions.cancel);
  const hadFocus = region.current?.contains(document.activeElement) ?? false;
  useLayoutEffect(() => {
    if (hadFocus && !isWaiting) opener.current?.focus();
    if (!isWaiting || loaded) return;
    import('./bones-form').then(
      ({ BonesForm }) => setLoaded({ Form: BonesForm }),
      (error: unknown) =>
        setComplaint(`The form for the bones could not be loaded: ${firstLine(reasonOf(error))}. Reload the page.`),
    );
  }, [isWaiting]);
  return (
    <div ref={region}>
      <Complaint text={complaint} />
      {skeleton && loaded && <loaded.Form key={skeleton.joints} skeleton={skeleton} {...actions} />}
    </div>
  );
}
