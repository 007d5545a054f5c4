/** The timeout of a request [ms]. */
const timeoutMs = 20_000;

interface Waiting<Answer> {
  resolve(answer: Answer): void;
  reject(error: Error): void;
}

/**
 * Sends requests to a worker that answers them in order. The worker is started with the first request and terminated
 * when none is pending.
 */
export class WorkerClient<Question, Answer> {
  readonly #name: string;
  readonly #begin: () => Worker;
  readonly #waiting: Waiting<Answer>[] = [];
  #worker: Worker | null = null;
  #patience: ReturnType<typeof setTimeout> | undefined;

  /** `name`: the name for messages. */
  constructor(name: string, begin: () => Worker) {
    this.#name = name;
    this.#begin = begin;
  }

  request(question: Question): Promise<Answer> {
    return new Promise((resolve, reject) => {
      this.#worker ??= this.#started();
      this.#waiting.push({ resolve, reject });
      this.#worker.postMessage(question);
      if (this.#waiting.length === 1) this.#wait();
    });
  }

  #started(): Worker {
    const worker = this.#begin();
    worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => {
      this.#waiting.shift()?.resolve(data);
      if (this.#waiting.length > 0) this.#wait();
      else this.#end();
    });
    worker.addEventListener('error', ({ message }) =>
      this.#fail(`${this.#name}: the decoder did not start (${message})`),
    );
    return worker;
  }

  #wait(): void {
    clearTimeout(this.#patience);
    this.#patience = setTimeout(() => this.#fail(`${this.#name}: unpacking it takes too long`), timeoutMs);
  }

  #fail(reason: string): void {
    for (const { reject } of this.#waiting.splice(0)) reject(new Error(reason));
    this.#end();
  }

  #end(): void {
    clearTimeout(this.#patience);
    this.#worker?.terminate();
    this.#worker = null;
  }
}
