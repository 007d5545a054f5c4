import { reasonOf } from '../core/errors/reasons';
import { createPlainRegressor } from '../core/estimation/networks/learned-network';
import { createSession, type InferenceSession } from './session';
import type { WorkerRequest, WorkerResponse } from './worker-session';

let session: Pick<InferenceSession, 'run'> | null = null;

async function answer(question: WorkerRequest): Promise<WorkerResponse> {
  const { id } = question;
  if ('weights' in question) {
    session = createPlainRegressor(question.contract, question.weights);
    return { id, inputNames: [], outputNames: [] };
  }
  if ('model' in question) {
    const opened = await createSession(question.model, question.tensors, 'wasm', { wasmPaths: question.wasmPaths });
    session = opened;
    return { id, inputNames: opened.inputNames, outputNames: opened.outputNames };
  }
  if (!session) throw new Error('no model is open');
  return { id, numbers: await session.run(question.features) };
}

// A server that renders pages imports the module, too: it has no messages.
globalThis.addEventListener?.('message', ({ data: question }: MessageEvent<WorkerRequest>) => {
  answer(question)
    .catch((error: unknown) => ({ id: question.id, broken: reasonOf(error) }))
    .then((answered) => globalThis.postMessage(answered));
});
