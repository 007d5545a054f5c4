import { join } from 'node:path';
import { expect, test } from 'vitest';
import { root } from '../../scripts/run-command.mjs';
import { countLine, readJUnit, readVitest } from '../../scripts/test-results.mjs';

test('in JUnit’s form, errors while setting up count as failures', () => {
  const report = `<testsuites><testsuite name="pytest" errors="1" failures="1" skipped="1" tests="4" time="1.2">
    <testcase classname="training.tests.test_frames" name="test_turns[a -&gt; b]" time="0.1" />
    <testcase classname="training.tests.test_frames" name="test_lost" time="0.1"><skipped type="pytest.skip">no GPU</skipped></testcase>
    <testcase classname="training.tests.test_model" name="test_gate" time="0.1"><failure message="assert 1 &lt; 0">E
      assert 1 &lt; 0</failure></testcase>
    <testcase classname="training.tests.test_model" name="test_export" time="0.0"><error message="no file">E</error></testcase>
  </testsuite></testsuites>`;
  const failures = ['training.tests.test_model: test_gate', 'training.tests.test_model: test_export'];
  expect(readJUnit(report)).toEqual({ passed: 1, failed: 2, skipped: 1, failures });
});

test('Playwright’s report names the file and the title of a failed test', () => {
  const report = `<testsuites><testsuite name="ball.spec.ts" hostname="day">
    <testcase name="a throw" classname="ball.spec.ts" time="1">
    </testcase><testcase name="a rest" classname="ball.spec.ts" time="0">
    <properties><property name="skip" value=""></property></properties>
    <skipped>
    </skipped>
    </testcase><testcase name="play › a catch" classname="ball.spec.ts" time="1"><failure message="m" type="FAILURE">
    <![CDATA[text]]></failure></testcase></testsuite></testsuites>`;
  expect(readJUnit(report)).toMatchObject({ passed: 1, skipped: 1, failures: ['ball.spec.ts: play › a catch'] });
});

const outcomes = (...statuses: string[]) =>
  statuses.map((status) => ({ status, fullName: `a test that ${status}`, tags: [] as string[] }));
const file = (name: string) => ({ name: join(root, 'tests', name) });

test('a file that Vitest cannot load counts as a failure', () => {
  const report = JSON.stringify({
    testResults: [
      { ...file('a.test.ts'), status: 'failed', assertionResults: [] },
      { ...file('b.test.ts'), status: 'failed', assertionResults: outcomes('passed', 'failed') },
      { ...file('c.test.ts'), status: 'passed', assertionResults: outcomes('passed', 'skipped', 'todo') },
    ],
  });
  const failures = ['tests/a.test.ts does not load', 'tests/b.test.ts: a test that failed'];
  expect(readVitest(report, false)).toEqual({ passed: 2, failed: 2, skipped: 2, failures });
});

test('a test that the filter of tags left out is not skipped', () => {
  const full = { status: 'skipped', tags: ['full'] };
  const tests = { ...file('a.test.ts'), assertionResults: [...outcomes('passed', 'skipped'), full] };
  const report = JSON.stringify({ testResults: [tests] });
  expect(readVitest(report, false)).toMatchObject({ passed: 1, skipped: 1 });
});

test('the closing line names the skipped only where there are any', () => {
  expect(countLine({ passed: 12, failed: 0, skipped: 0 })).toBe('12 passed, 0 failed');
  expect(countLine({ passed: 12, failed: 1, skipped: 2 })).toBe('12 passed, 1 failed, 2 skipped');
});
