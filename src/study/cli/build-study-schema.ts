// npx tsx src/study/cli/build-study-schema.ts writes public/studies/plan.schema.json from the schema that the program
// uses to read plans, and public/studies/phrases.json, the phrases of the page, to be translated in a plan.
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { shippedPhrases } from '../model/phrases/phrases';
import { planJsonSchema } from './check/plan-json-schema';

const write = (name: string, value: object) =>
  writeFileSync(
    fileURLToPath(new URL(`../../../public/studies/${name}`, import.meta.url)),
    `${JSON.stringify(value, null, 2)}\n`,
  );

write('plan.schema.json', planJsonSchema());
write('phrases.json', shippedPhrases);
