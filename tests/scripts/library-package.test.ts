import { readFileSync } from 'node:fs';
import { describe, expect, test } from 'vitest';
import { documentInPackage } from '../../scripts/build-library.mjs';

const read = (path: string): string => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');
const peopleOf = (model: string): string[] => JSON.parse(read(`public/models/${model}.json`)).trainedOn.people;

describe('the licence', () => {
  test('names the people whose motion the networks are trained on, all of them and nobody else', () => {
    const [named] = read('LICENSE').match(/(?<=subjects \()[\d,\s]+(?=\))/) ?? [];
    const people = new Set([...peopleOf('learned'), ...peopleOf('paper')]);
    expect(named?.split(/,\s+/)).toEqual([...people].sort());
  });
});

describe('a document of the package', () => {
  const files = {
    'README.md': 'src/threepoint/README.md',
    'models/README.md': 'src/threepoint/model-card.md',
    LICENSE: 'LICENSE',
  };

  test('leads to files of the package; what else it links to stays as text', () => {
    const text =
      'See [card](model-card.md#limits), [licence](../../LICENSE), [examples](../../examples) and ![a](x.svg).';
    expect(documentInPackage(text, 'README.md', files)).toBe(
      'See [card](models/README.md#limits), [licence](LICENSE), examples and a.',
    );
  });

  test('keeps addresses and links within itself', () => {
    const text = '[three.js](https://threejs.org), [frames](#frames)';
    expect(documentInPackage(text, 'README.md', files)).toBe(text);
  });
});
