// npm run build:study-schema: public/studies/plan.schema.json from the schema by which the program itself reads plans.
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { planJsonSchema } from './study-check/plan-json-schema';

const file = fileURLToPath(new URL('../public/studies/plan.schema.json', import.meta.url));
writeFileSync(file, `${JSON.stringify(planJsonSchema(), null, 2)}\n`);
