import { toJsonSchema } from '@valibot/to-json-schema';
import { planSchema } from '../../model/plan/plan-schema';

/**
 * Returns the schema of plans as JSON Schema (draft 7), for completion in editors. `npm run tool -- study:check` also
 * checks what JSON Schema cannot express, such as that the questionnaire of a task exists.
 */
export const planJsonSchema = (): object => ({
  // JSON Schema has no term for trimming and finiteness, and JSON has no infinite numbers.
  ...toJsonSchema(planSchema, { errorMode: 'ignore', target: 'draft-07' }),
  title: 'A study of threepoint',
});
