import * as v from 'valibot';
import { reasonOf } from '../core/errors/reasons';
import { learnedInputCount } from '../core/estimation/methods/residual';
import type { ModelContract } from '../core/estimation/networks/pose-regressor';
import type { ModelTensors } from './session';

const statedFile = {
  file: v.pipe(v.string(), v.regex(/^[\w.-]+$/, 'expected a file name beside the contract')),
  bytes: v.pipe(v.number(), v.integer(), v.minValue(1)),
  sha256: v.pipe(v.string(), v.regex(/^[0-9a-f]{64}$/, 'expected 64 hexadecimal digits')),
};

const tensor = v.object({
  name: v.string(),
  shape: v.pipe(v.array(v.pipe(v.number(), v.integer(), v.minValue(1))), v.minLength(1)),
  meaning: v.string(),
  unit: v.string(),
  frame: v.picklist(['heading', 'chest']),
});

const contractSchema = v.object({
  name: v.picklist(['paper', 'learned']),
  version: v.string(),
  ...statedFile,
  inputs: v.pipe(v.array(tensor), v.length(1)),
  outputs: v.pipe(v.array(tensor), v.length(1)),
  rateHz: v.number(),
  windowSeconds: v.pipe(v.array(v.pipe(v.number(), v.minValue(0))), v.minLength(1)),
  quantisation: v.object({ scheme: v.string(), maxAbsoluteDifference: v.number() }),
  trainedOn: v.object({ corpus: v.string(), corpusHash: v.string(), people: v.array(v.string()) }),
  gitCommit: v.string(),
  seed: v.number(),
  errors: v.record(v.string(), v.record(v.string(), v.number())),
  weights: v.optional(
    v.object({
      ...statedFile,
      tensors: v.record(v.string(), v.pipe(v.string(), v.regex(/^(float32|int16|int8)( \d+)+$/))),
    }),
  ),
});

/** The numbers of six joints: x, y and z. */
export const outputNumbers = 18;

/** Parses a contract from JSON; throws a sentence that names the file and the missing or invalid field. */
export function parseContract(file: string, text: string): ModelContract {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch (error) {
    throw new Error(`${file}: no valid JSON (${reasonOf(error)})`);
  }
  const result = v.safeParse(contractSchema, json);
  if (!result.success) {
    const [issue] = result.issues;
    throw new Error(`${file}: ${v.getDotPath(issue) ?? 'the contract'}: ${issue.message}`);
  }
  // Absent fields stay absent: exact optional properties do not accept undefined.
  const { weights, ...contract } = result.output;
  const { name, windowSeconds } = contract;
  const expected = name === 'paper' ? 18 : learnedInputCount(windowSeconds);
  const count = (shape: readonly number[]) => shape.reduce((product, size) => product * size, 1);
  const [input, output] = [contract.inputs[0], contract.outputs[0]];
  if (input === undefined || count(input.shape) !== expected) {
    throw new Error(`${file}: expected ${input ? count(input.shape) : 0} features, the page makes ${expected}`);
  }
  if (output === undefined || count(output.shape) !== outputNumbers) {
    throw new Error(`${file}: ${output ? count(output.shape) : 0} numbers come out, six joints are ${outputNumbers}`);
  }
  return {
    ...contract,
    ...(weights !== undefined && { weights }),
  };
}

/** Returns the tensors that a contract names, in the form of a session. */
export function tensorsOf({ inputs, outputs }: ModelContract): ModelTensors {
  const [input, output] = [inputs[0]!, outputs[0]!];
  return { input: input.name, inputShape: input.shape, output: output.name };
}
