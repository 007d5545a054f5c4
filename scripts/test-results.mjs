import { existsSync, readFileSync } from 'node:fs';
import { relative, sep } from 'node:path';

/** Returns the path of a file from here, with slashes on every platform. */
const shortPath = (file) => relative('.', file).split(sep).join('/');

/** Returns the specs of a suite in Playwright's report, including those of nested suites. */
const specsOf = ({ specs = [], suites = [] }) => [...specs, ...suites.flatMap(specsOf)];

const readers = {
  /**
   * Reads Vitest's report. `chosen`: whether tests of these tags were selected; the runner counts all others as
   * skipped.
   */
  vitest(text, chosen = () => true) {
    const report = JSON.parse(text);
    const tests = report.testResults.flatMap((file) =>
      file.assertionResults.map((test) => ({ ...test, file: shortPath(file.name) })),
    );
    const asked = tests.filter(({ tags = [] }) => chosen(tags));
    const of = (...kinds) => asked.filter(({ status }) => kinds.includes(status));
    // A file that fails to load has no tests that could fail.
    const broken = report.testResults.filter((file) => file.status === 'failed' && file.assertionResults.length === 0);
    return {
      passed: of('passed').length,
      failures: [
        ...broken.map((file) => `${shortPath(file.name)} does not load`),
        ...of('failed').map(({ file, fullName }) => `${file}: ${fullName}`),
      ],
      skipped: of('skipped', 'pending', 'todo').length,
    };
  },
  pytest(text) {
    const skipped = [...text.matchAll(/<skipped\s/g)].length;
    const cases = [...text.matchAll(/<testcase\s([^>]*?)(?:\/>|>(.*?)<\/testcase>)/gs)];
    const attribute = (attributes, name) => new RegExp(`\\s${name}="([^"]*)"`).exec(` ${attributes}`)?.[1];
    const failures = cases
      .filter(([, , body]) => /<(failure|error)\s/.test(body ?? ''))
      .map(([, attributes]) => `${attribute(attributes, 'classname')}: ${attribute(attributes, 'name')}`);
    return { passed: cases.length - failures.length - skipped, failures, skipped };
  },
  playwright(text) {
    const { stats, errors, suites } = JSON.parse(text);
    const specs = suites.flatMap(specsOf).filter(({ ok }) => !ok);
    return {
      passed: stats.expected + stats.flaky,
      // These errors are outside all tests: a configuration that does not load, a server that does not start.
      failures: [
        ...errors.map(({ message = 'an error without words' }) => message.split('\n')[0]),
        ...specs.map(({ file, title }) => `${file}: ${title}`),
      ],
      skipped: stats.skipped,
    };
  },
};

/** Returns the counts of a runner's report file by outcome and the names of failed tests; null if there is no file. */
export function readResults(runner, file, chosen) {
  if (!existsSync(file)) return null;
  const { passed, failures, skipped } = readers[runner](readFileSync(file, 'utf8'), chosen);
  return { passed, failed: failures.length, skipped, failures };
}

/** Returns the last line of a run: '12 passed, 0 failed', and the skipped tests if there are any. */
export function countLine({ passed, failed, skipped }) {
  return `${passed} passed, ${failed} failed${skipped ? `, ${skipped} skipped` : ''}`;
}
