import { existsSync, readFileSync } from 'node:fs';
import { join, relative, sep } from 'node:path';
import { root } from './run-command.mjs';

/** The folder of the runners' reports, as vitest.config.ts, playwright.config.ts and test-python.mjs name them. */
export const reports = join(root, 'artifacts/test-reports');

/** Reads a report in JUnit's form, as pytest and Playwright write it. */
function readJUnit(text) {
  const cases = [...text.matchAll(/<testcase\s([^>]*?)(?:\/>|>(.*?)<\/testcase>)/gs)];
  const withTag = (tag) => cases.filter(([, , body]) => new RegExp(`<(${tag})[\\s>/]`).test(body ?? ''));
  const attribute = (attributes, name) => new RegExp(`\\b${name}="([^"]*)"`).exec(attributes)?.[1];
  const titles = (tag) =>
    withTag(tag).map(([, attributes]) => `${attribute(attributes, 'classname')}: ${attribute(attributes, 'name')}`);
  const failures = titles('failure|error');
  const skipped = withTag('skipped').length;
  const passed = cases.length - failures.length - skipped;
  return { passed, failed: failures.length, skipped, failures, repeated: titles('flakyFailure|flakyError') };
}

/**
 * Reads Vitest's own report of the tests that are tagged `full`, or of all others. The runner counts tests that its
 * filter left out as skipped.
 */
function readVitest(text, isFull) {
  const files = JSON.parse(text).testResults.map((file) => ({
    ...file,
    name: relative(root, file.name).replaceAll(sep, '/'),
  }));
  const tests = files.flatMap(({ name, assertionResults }) =>
    assertionResults
      .filter(({ tags }) => tags.includes('full') === isFull)
      .map((test) => ({ ...test, title: `${name}: ${test.fullName}` })),
  );
  const having = (...kinds) => tests.filter(({ status }) => kinds.includes(status));
  // A file that fails to load has no tests that could fail.
  const broken = files.filter(({ status, assertionResults }) => status === 'failed' && assertionResults.length === 0);
  const failures = [
    ...broken.map(({ name }) => `${name} does not load`),
    ...having('failed').map(({ title }) => title),
  ];
  const skipped = having('skipped', 'pending', 'todo').length;
  return { passed: having('passed').length, failed: failures.length, skipped, failures };
}

/** Returns the counts of an npm script by its report, with the names of failed tests; null if it wrote none. */
export function readResults(script) {
  const [runner] = /unit|e2e|python/.exec(script) ?? [];
  const file = join(reports, `${runner}.${runner === 'unit' ? 'json' : 'xml'}`);
  if (!existsSync(file)) return null;
  const text = readFileSync(file, 'utf8');
  return runner === 'unit' ? readVitest(text, script.endsWith('-full')) : readJUnit(text);
}

/** Returns the last line of a run: '12 passed, 0 failed', and the skipped tests if there are any. */
export const countLine = ({ passed, failed, skipped }) =>
  `${passed} passed, ${failed} failed${skipped ? `, ${skipped} skipped` : ''}`;
