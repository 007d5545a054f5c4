/** A decoder that is silent for longer [ms] is not worth the wait. */
const patienceMs = 20_000;

interface Waiting<Answer> {
  resolve(answer: Answer): void;
  reject(error: Error): void;
}

/**
 * A worker that answers in the order in which it is asked. It begins with the first question and ends when none is
 * left.
 */
export class WorkerClient<Question, Answer> {
  readonly #name: string;
  readonly #begin: () => Worker;
  readonly #waiting: Waiting<Answer>[] = [];
  #worker: Worker | null = null;
  #patience: ReturnType<typeof setTimeout> | undefined;

  /** `name`: what sentences call it. */
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
    this.#patience = setTimeout(() => this.#fail(`${this.#name}: unpacking it takes too long`), patienceMs);
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
