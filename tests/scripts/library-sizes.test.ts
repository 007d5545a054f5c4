import { describe, expect, test } from 'vitest';
import { staleSizes } from '../../scripts/library-sizes.mjs';

const table = `| entry | minified | brotli |
|---|---|---|
| \`threepoint\` | 71.0 kB | 25.2 kB |
| \`threepoint/motion\` | 45.5 kB | 17.0 kB |
`;

const rowOf = (entry: string) => new RegExp(`^\\| \`${entry}\` \\| ([\\d.]+) kB \\| ([\\d.]+) kB \\|$`, 'm');
const stale = (entry: string, ...bytes: number[]): readonly string[] =>
  staleSizes('src/threepoint/README.md', table, [{ what: entry, says: rowOf(entry), bytes }]);

describe('a size that a document says', () => {
  test('is let stand within 3 % of what was measured', () => {
    expect(stale('threepoint', 71_000, 25_200)).toEqual([]);
    expect(stale('threepoint', 73_100, 24_500)).toEqual([]);
  });

  test('is let stand where what was measured rounds to it', () => {
    const text = '| `threepoint/onnx-worker` | 1.4 kB | 0.7 kB |';
    const says = rowOf('threepoint/onnx-worker');
    const claim = (...bytes: number[]) => staleSizes('src/threepoint/README.md', text, [{ what: 'it', says, bytes }]);
    expect(claim(1_360, 660)).toEqual([]);
    expect(claim(1_360, 640)).toEqual([
      'src/threepoint/README.md says 1.4 kB and 0.7 kB of it, it is 1.4 kB and 0.6 kB',
    ]);
  });

  test('is reported with what was measured where it is further off', () => {
    expect(stale('threepoint/motion', 45_500, 18_049)).toEqual([
      'src/threepoint/README.md says 45.5 kB and 17.0 kB of threepoint/motion, it is 45.5 kB and 18.0 kB',
    ]);
  });

  test('is missed where the document says none', () => {
    expect(stale('threepoint/onnx', 1)).toEqual(['src/threepoint/README.md does not say what threepoint/onnx weighs']);
  });
});
