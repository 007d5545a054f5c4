import { reasonOf } from '../core/errors/reasons';
import { createSession, type InferenceSession } from './session';
import type { WorkerRequest, WorkerResponse } from './worker-session';

let session: InferenceSession | null = null;

async function answer(question: WorkerRequest): Promise<WorkerResponse> {
  const { id } = question;
  if ('model' in question) {
    session = await createSession(question.model, question.tensors, 'wasm', { wasmPaths: question.wasmPaths });
    return { id, inputNames: session.inputNames, outputNames: session.outputNames };
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
