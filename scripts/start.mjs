import { buildWhenStale } from './build.mjs';
import { ensureInstalled } from './installation.mjs';
import { main } from './run-command.mjs';

/** npm passes a signal only to the shell between us: when that shell is gone, whoever ran `npm start` has stopped it. */
function stopWithParent() {
  const parent = process.ppid;
  setInterval(() => {
    if (process.ppid !== parent) process.kill(process.pid, 'SIGTERM');
  }, 500).unref();
}

await main(async () => {
  if (process.env.npm_lifecycle_event) stopWithParent();
  await ensureInstalled();
  if (!process.argv.includes('--help')) await buildWhenStale();
  // Found only now: tsx may just have been installed.
  const { register } = await import('tsx/esm/api');
  register();
  await import('../server/main.ts');
});
