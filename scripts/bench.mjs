// npm run tool -- bench [--json FILE] [visit counts frames archery ball crowd allocations networks avatar] [--rounds
// N]: measures the time of a frame by estimator and by stage, in headless Chromium. Without names it measures every
// part, which takes an hour on two cores without a GPU; "frames --rounds 3" takes minutes. "counts" counts what each
// world draws, and fails where a budget is exceeded. npm run tool -- bench networks --device: uses WebGPU on the
// machine's GPU instead of in software. Each part prints its duration and is written to FILE when it ends; ratios of
// frames have 95 % confidence intervals. npm run tool -- bench --allocations [ik paper learned mirror archery ball3
// ball8 hands stillScene]: measures only the garbage that frames allocate, and the functions that allocate it.
import { buildWhenStale } from './build.mjs';
import { ensureChromium } from './chromium.mjs';
import { readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { main, root, run, runProgram } from './run-command.mjs';

const usage = 'npm run tool -- bench [--json FILE] [PART …] [--rounds N] [--allocations] [--device] [--avatar FILE]';

const vite = (...options) => run('npx', ['vite', 'build', '--logLevel', 'warn', ...options], { cwd: root });
/** The build options of benchmarks: function names and source maps are kept. */
const readable = ['--minify', 'false', '--sourcemap'];

await main(async () => {
  const known = { texts: ['rounds'], paths: ['json', 'avatar'], flags: ['allocations', 'device'], rest: 'words' };
  const given = readOptions('bench', usage, known);
  await ensureInstalled();
  await ensureChromium();
  if (given.allocations) {
    const { code } = await vite('--outDir', '.cache/bench-of-page', '--emptyOutDir', ...readable);
    if (code !== 0) return code;
  } else await buildWhenStale();
  const page = await vite('--config', 'bench/vite.config.ts', ...(given.allocations ? readable : []));
  if (page.code !== 0) return page.code;
  return runProgram('bench/main.ts', [JSON.stringify(given)]);
});
