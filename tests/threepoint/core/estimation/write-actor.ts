// node --import tsx tests/threepoint/core/estimation/write-actor.ts: writes the estimates of the built-in actor into
// tests/golden/actor.json, after constants or networks were changed on purpose (actor-estimates.test.ts).
import { writeFileSync } from 'node:fs';
import { actorEstimators, estimateActor } from './actor-estimates';

const estimates = estimateActor();
const lists = actorEstimators.map((name) => {
  const rows = estimates[name].map((row) => `[${row.map((value) => value.toFixed(5)).join(', ')}]`);
  return `"${name}": [\n${rows.join(',\n')}\n]`;
});
writeFileSync(new URL('../../../golden/actor.json', import.meta.url), `{\n${lists.join(',\n')}\n}\n`);
