import { toJsonSchema } from '@valibot/to-json-schema';
import { planSchema } from '../../model/plan/plan-schema';

/**
 * The schema by which plans are read, as JSON Schema (draft 7), for completion in editors. What JSON Schema cannot say, such as that a
 * task names a questionnaire that is there, `npm run study:check` says.
 */
export const planJsonSchema = (): object => ({
  // Trimming and finiteness have no word in JSON Schema and need none: JSON knows no infinite number.
  ...toJsonSchema(planSchema, { errorMode: 'ignore', target: 'draft-07' }),
  title: 'A study of threepoint',
});
