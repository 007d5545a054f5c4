// npm run bench:relay [-- --json FILE] [--quick]: measures how many clients a relay process carries, next to a plain
// socket.io relay.
import { passedOn, readOptions, runAsScript } from './command-line.mjs';

const usage = 'npm run bench:relay [-- --json FILE] [--quick] [--rooms N] [--hz N] [--seconds N] [--count N]';
const texts = ['rooms', 'hz', 'seconds', 'count'];

await runAsScript('bench/relay/main.ts', () => {
  const given = readOptions('bench:relay', usage, { texts: [...texts, 'json'], flags: ['quick'] });
  return passedOn(given, [...texts, 'quick'], ['json']);
});
