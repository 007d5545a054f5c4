import { expect, test } from 'vitest';
import { recorderText } from '../../../../src/page/shell/panels/recording-page';

test('the words of a recording change when it begins and ends, its figures every second', () => {
  const recorder = { paused: false, duration: 0, loop: true, name: null };
  const texts = [0, 4.5, 9.75].map((seconds) => recorderText({ ...recorder, mode: 'recording', seconds }));
  expect(texts).toEqual([
    ['Recording', ', 0.0 s'],
    ['Recording', ', 4.5 s'],
    ['Recording', ', 9.8 s'],
  ]);
  const over = { ...recorder, mode: 'idle', seconds: 0, duration: 9.75, name: 'recording-1.json' } as const;
  expect(recorderText(over)).toEqual(['recording-1.json, 9.8 s', '']);
});
