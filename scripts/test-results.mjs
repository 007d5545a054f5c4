import { existsSync, readFileSync } from 'node:fs';

const readers = {
  /** `chosen`: whether tests of these tags were asked for; the runner counts all others as skipped. */
  vitest(text, chosen = () => true) {
    const report = JSON.parse(text);
    const tests = report.testResults.flatMap((file) => file.assertionResults).filter(({ tags = [] }) => chosen(tags));
    const count = (...kinds) => tests.filter(({ status }) => kinds.includes(status)).length;
    // A file that does not even load has no tests of its own to fail.
    const broken = report.testResults.filter((file) => file.status === 'failed' && file.assertionResults.length === 0);
    return {
      passed: count('passed'),
      failed: count('failed') + broken.length,
      skipped: count('skipped', 'pending', 'todo'),
    };
  },
  pytest(text) {
    const sum = (attribute) =>
      [...text.matchAll(/<testsuite\s[^>]*>/g)].reduce(
        (total, [suite]) => total + Number(new RegExp(`\\s${attribute}="(\\d+)"`).exec(suite)?.[1] ?? 0),
        0,
      );
    const failed = sum('failures') + sum('errors');
    return { passed: Math.max(0, sum('tests') - failed - sum('skipped')), failed, skipped: sum('skipped') };
  },
  playwright(text) {
    const { stats, errors } = JSON.parse(text);
    // Errors outside every test: a configuration that does not load, a server that does not start.
    return { passed: stats.expected + stats.flaky, failed: stats.unexpected + errors.length, skipped: stats.skipped };
  },
};

/** Tests by outcome, as a runner's report file states them; null where it wrote none. */
export function readResults(runner, file, chosen) {
  return existsSync(file) ? readers[runner](readFileSync(file, 'utf8'), chosen) : null;
}

/** The line that ends a run: '12 passed, 0 failed', with the skipped where there are any. */
export function countLine({ passed, failed, skipped }) {
  return `${passed} passed, ${failed} failed${skipped ? `, ${skipped} skipped` : ''}`;
}
