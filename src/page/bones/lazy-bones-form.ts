import { firstLine, reasonOf } from 'threepoint/core';
import { element } from 'threepoint-ui';
import type { BonesActions, createBonesForm } from './bones-form';
import type { SkeletonToMap } from './skeleton-to-map';

/** Shows the form for the bones of a file. Its code is loaded once a file waits for them. */
export function createLazyBonesForm(actions: BonesActions) {
  const node = element('div', {});
  let waiting: SkeletonToMap | null = null;
  let form: ReturnType<typeof createBonesForm> | null = null;
  let isLoading = false;
  async function load(): Promise<void> {
    isLoading = true;
    try {
      const { createBonesForm } = await import('./bones-form');
      form = createBonesForm(actions);
      node.replaceChildren(form.node);
      form.show(waiting);
    } catch (error) {
      const text = `The form for the bones could not be loaded: ${firstLine(reasonOf(error))}. Reload the page.`;
      node.replaceChildren(element('p', { class: 'complaint', role: 'alert' }, text));
    }
  }
  return {
    node,
    show(skeleton: SkeletonToMap | null): void {
      waiting = skeleton;
      if (form) form.show(waiting);
      else if (waiting && !isLoading) void load();
    },
  };
}
