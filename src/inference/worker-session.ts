import type { InferenceSession } from './session';
import type { Answer, Question } from './worker-messages';

/** A question without its number. */
type Asked = Question extends infer One ? (One extends Question ? Omit<One, 'id'> : never) : never;

interface Waiting {
  readonly resolve: (answer: Answer) => void;
  readonly reject: (error: Error) => void;
}

/**
 * Opens a model in a worker of its own: what a frame pays for a run is to ask for it; the answer arrives between frames. Rejects when
 * there is no worker or it does not take the model; a worker that breaks rejects every run from then on.
 */
export async function createWorkerSession(model: Uint8Array): Promise<InferenceSession> {
  const worker = new Worker(new URL('./inference-worker.ts', import.meta.url), { type: 'module' });
  const waiting = new Map<number, Waiting>();
  let broken: Error | null = null;
  let asked = 0;

  function breakDown(reason: string): void {
    broken = new Error(reason);
    worker.terminate();
    for (const { reject } of waiting.values()) reject(broken);
    waiting.clear();
  }

  function ask(question: Asked): Promise<Answer> {
    if (broken) return Promise.reject(broken);
    const id = asked++;
    return new Promise<Answer>((resolve, reject) => {
      waiting.set(id, { resolve, reject });
      worker.postMessage({ id, ...question });
    });
  }

  worker.addEventListener('message', ({ data: answer }: MessageEvent<Answer>) => {
    const asker = waiting.get(answer.id);
    waiting.delete(answer.id);
    if ('broken' in answer) asker?.reject(new Error(answer.broken));
    else asker?.resolve(answer);
  });
  worker.addEventListener('error', ({ message }) => breakDown(message || 'the worker for inference did not start'));
  worker.addEventListener('messageerror', () => breakDown('the worker for inference cannot be understood'));

  const opened = await ask({ model }).catch((error: unknown) => {
    worker.terminate();
    throw error;
  });
  if (!('inputNames' in opened)) throw new Error('the worker for inference answers what nobody asked');
  return {
    provider: 'wasm',
    resolvesInFrame: false,
    inputNames: opened.inputNames,
    outputNames: opened.outputNames,
    async run(input, features, output) {
      const answer = await ask({ input, features, output });
      if (!('numbers' in answer)) throw new Error('the worker for inference answers what nobody asked');
      return answer.numbers;
    },
    async release() {
      breakDown('already released');
    },
  };
}
