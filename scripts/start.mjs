import { buildWhenStale } from './build.mjs';
import { ensureInstalled } from './installation.mjs';
import { main } from './run-command.mjs';

await main(async () => {
  await ensureInstalled();
  if (!process.argv.includes('--help')) await buildWhenStale();
  // Found only now: tsx may just have been installed.
  const { register } = await import('tsx/esm/api');
  register();
  await import('../server/main.ts');
});
