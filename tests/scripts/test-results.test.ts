import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { countLine, readResults } from '../../scripts/test-results.mjs';
import { directoryWith } from '../temporary-directory';

function report(content: unknown): string {
  const text = typeof content === 'string' ? content : JSON.stringify(content);
  return join(directoryWith({ report: text }), 'report');
}

test('pytest: errors while setting up count as failures', () => {
  const file = report(
    '<testsuites><testsuite name="pytest" errors="1" failures="2" skipped="3" tests="10" time="1.2"></testsuite></testsuites>',
  );
  expect(readResults('pytest', file)).toEqual({ passed: 4, failed: 3, skipped: 3 });
});

describe('vitest', () => {
  const outcomes = (...statuses: string[]) => statuses.map((status) => ({ status, tags: [] }));

  test('a file that does not load counts as a failure', () => {
    const file = report({
      testResults: [
        { status: 'failed', assertionResults: [] },
        { status: 'failed', assertionResults: outcomes('passed', 'failed') },
        { status: 'passed', assertionResults: outcomes('passed', 'skipped', 'todo') },
      ],
    });
    expect(readResults('vitest', file)).toEqual({ passed: 2, failed: 2, skipped: 2 });
  });

  test('what was not asked for is not skipped', () => {
    const full = { status: 'skipped', tags: ['full'] };
    const file = report({
      testResults: [{ status: 'passed', assertionResults: [...outcomes('passed', 'skipped'), full] }],
    });
    expect(readResults('vitest', file, (tags: string[]) => !tags.includes('full'))).toEqual({
      passed: 1,
      failed: 0,
      skipped: 1,
    });
  });
});

test('Playwright: a server that does not start counts as a failure, a test that needed a second try does not', () => {
  const file = report({
    stats: { expected: 5, unexpected: 1, flaky: 1, skipped: 2 },
    errors: [{ message: 'no server' }],
  });
  expect(readResults('playwright', file)).toEqual({ passed: 6, failed: 2, skipped: 2 });
});

test('a runner that died before its report has no results', () => {
  expect(readResults('vitest', '/nowhere/report.json')).toBeNull();
});

test('the closing line names the skipped only where there are any', () => {
  expect(countLine({ passed: 12, failed: 0, skipped: 0 })).toBe('12 passed, 0 failed');
  expect(countLine({ passed: 12, failed: 1, skipped: 2 })).toBe('12 passed, 1 failed, 2 skipped');
});
