import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { countLine, readResults } from '../../scripts/test-results.mjs';
import { directoryWith } from '../temporary-directory';

function report(content: unknown): string {
  const text = typeof content === 'string' ? content : JSON.stringify(content);
  return join(directoryWith({ report: text }), 'report');
}

test('pytest: errors while setting up count as failures', () => {
  const file = report(`<testsuites><testsuite name="pytest" errors="1" failures="1" skipped="1" tests="4" time="1.2">
    <testcase classname="training.tests.test_frames" name="test_turns[a -&gt; b]" time="0.1" />
    <testcase classname="training.tests.test_frames" name="test_lost" time="0.1"><skipped type="pytest.skip">no GPU</skipped></testcase>
    <testcase classname="training.tests.test_model" name="test_gate" time="0.1"><failure message="assert 1 &lt; 0">E
      assert 1 &lt; 0</failure></testcase>
    <testcase classname="training.tests.test_model" name="test_export" time="0.0"><error message="no file">E</error></testcase>
  </testsuite></testsuites>`);
  expect(readResults('pytest', file)).toEqual({
    passed: 1,
    failed: 2,
    skipped: 1,
    failures: ['training.tests.test_model: test_gate', 'training.tests.test_model: test_export'],
  });
});

describe('vitest', () => {
  const outcomes = (...statuses: string[]) =>
    statuses.map((status) => ({ status, fullName: `a test that ${status}`, tags: [] }));
  const file = (name: string) => ({ name: join(process.cwd(), 'tests', name) });

  test('a file that does not load counts as a failure', () => {
    const written = report({
      testResults: [
        { ...file('a.test.ts'), status: 'failed', assertionResults: [] },
        { ...file('b.test.ts'), status: 'failed', assertionResults: outcomes('passed', 'failed') },
        { ...file('c.test.ts'), status: 'passed', assertionResults: outcomes('passed', 'skipped', 'todo') },
      ],
    });
    expect(readResults('vitest', written)).toEqual({
      passed: 2,
      failed: 2,
      skipped: 2,
      failures: ['tests/a.test.ts does not load', 'tests/b.test.ts: a test that failed'],
    });
  });

  test('what was not asked for is not skipped', () => {
    const full = { status: 'skipped', tags: ['full'] };
    const written = report({
      testResults: [
        { ...file('a.test.ts'), status: 'passed', assertionResults: [...outcomes('passed', 'skipped'), full] },
      ],
    });
    expect(readResults('vitest', written, (tags: string[]) => !tags.includes('full'))).toMatchObject({
      passed: 1,
      failed: 0,
      skipped: 1,
    });
  });
});

test('Playwright: a server that does not start counts as a failure, a test that needed a second try does not', () => {
  const file = report({
    stats: { expected: 5, unexpected: 1, flaky: 1, skipped: 2 },
    errors: [{ message: 'no server\n  at start' }],
    suites: [
      {
        specs: [{ file: 'ball.spec.ts', title: 'a throw', ok: true }],
        suites: [{ specs: [{ file: 'ball.spec.ts', title: 'a catch', ok: false }] }],
      },
    ],
  });
  expect(readResults('playwright', file)).toEqual({
    passed: 6,
    failed: 2,
    skipped: 2,
    failures: ['no server', 'ball.spec.ts: a catch'],
  });
});

test('a runner that died before its report has no results', () => {
  expect(readResults('vitest', '/nowhere/report.json')).toBeNull();
});

test('the closing line names the skipped only where there are any', () => {
  expect(countLine({ passed: 12, failed: 0, skipped: 0 })).toBe('12 passed, 0 failed');
  expect(countLine({ passed: 12, failed: 1, skipped: 2 })).toBe('12 passed, 1 failed, 2 skipped');
});
