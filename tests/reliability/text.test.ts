import { readdirSync, readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { reportFigures } from './report-figures';

const source = new URL('../../src/', import.meta.url);

test('no code of the page turns text into markup', () => {
  const files = readdirSync(source, { recursive: true, encoding: 'utf8' }).filter((file) => file.endsWith('.ts'));
  expect(files.length).toBeGreaterThan(100);
  const sinks =
    /\.(innerHTML|outerHTML)\s*=|insertAdjacentHTML|document\.write|createContextualFragment|DOMParser|srcdoc/;
  const found = files.filter((file) => sinks.test(readFileSync(new URL(file, source), 'utf8')));
  expect(found).toEqual([]);
  reportFigures('text', { 'files that make markup of text': `${found.length} of ${files.length}` });
});
