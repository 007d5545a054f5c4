import { createStatusLine } from 'threepoint-ui';
import { beforeEach, expect, test, vi } from 'vitest';
import { recorderText } from '../../../../src/page/shell/panels/recording-page';

/** The part of an element that a line of text needs; it counts how often its text was set. */
class Element {
  readonly children: Element[] = [];
  readonly attributes: Record<string, string> = {};
  times = 0;
  #text = '';
  get textContent(): string {
    return this.#text;
  }
  set textContent(text: string) {
    this.times += 1;
    this.#text = text;
  }
  setAttribute(name: string, value: string): void {
    this.attributes[name] = value;
  }
  append(...children: Element[]): void {
    this.children.push(...children);
  }
}

beforeEach(() => vi.stubGlobal('document', { createElement: () => new Element() }));

test('a recording is announced when it begins and ends, not with every look at its seconds', () => {
  const line = createStatusLine();
  const [said, running] = (line.node as unknown as Element).children as [Element, Element];
  expect([said.attributes.role, running.attributes.role]).toEqual(['status', undefined]);
  const recorder = { paused: false, duration: 0, loop: true, name: null };
  for (let look = 0; look < 40; look++)
    line.show(...recorderText({ ...recorder, mode: 'recording', seconds: look / 4 }));
  expect([said.times, said.textContent, running.textContent]).toEqual([1, 'Recording', ', 9.8 s']);
  const over = { ...recorder, mode: 'idle', seconds: 0, duration: 9.75, name: 'recording-1.json' } as const;
  for (let look = 0; look < 40; look++) line.show(...recorderText(over));
  expect([said.times, said.textContent, running.textContent]).toEqual([2, 'recording-1.json, 9.8 s', '']);
});
