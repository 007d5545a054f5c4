import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { createNoticeList, type Notice } from '../../src/ui/notices';

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

function notices() {
  let drawn: readonly Notice[] = [];
  const list = createNoticeList((next) => {
    drawn = next;
  });
  return { ...list, texts: () => drawn.map(({ text }) => text) };
}

test('notices are shown once each, at most three at a time', () => {
  const { show, texts } = notices();
  for (const text of ['one', 'two', 'two', 'three', 'four']) show('warning', text);
  expect(texts()).toEqual(['two', 'three', 'four']);
});

test('a notice replaces the older one about its subject, and leaves when that is over', () => {
  const { show, withdraw, texts } = notices();
  show('error', 'a.vrm could not be shown: it has no head.', 'avatar');
  show('error', 'VR could not be entered.', 'session');
  show('info', 'b.vrm is your avatar now.', 'avatar');
  expect(texts()).toEqual(['VR could not be entered.', 'b.vrm is your avatar now.']);
  withdraw('session');
  expect(texts()).toEqual(['b.vrm is your avatar now.']);
});

test('an information leaves after six seconds from its last repetition, trouble when it is closed', () => {
  const { show, close, texts } = notices();
  show('error', 'No motion in walk.txt.', 'motion');
  show('info', 'Ready.');
  vi.advanceTimersByTime(4000);
  show('info', 'Ready.');
  vi.advanceTimersByTime(4000);
  expect(texts()).toEqual(['No motion in walk.txt.', 'Ready.']);
  vi.advanceTimersByTime(2000);
  expect(texts()).toEqual(['No motion in walk.txt.']);
  close('No motion in walk.txt.');
  expect(texts()).toEqual([]);
});
