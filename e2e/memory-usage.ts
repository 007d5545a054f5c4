import { once } from 'node:events';
import type { CDPSession } from '@playwright/test';
import { WebSocket } from 'ws';

export const megabytes = (bytes: number) => bytes / 2 ** 20;

/**
 * Collects garbage and returns a lookup of Chromium's performance metrics of the page, by Chromium's names; NaN for an
 * unknown name. Requires `Performance.enable`.
 */
export async function countsOf(cdp: CDPSession): Promise<(name: string) => number> {
  // The second collection frees what finalizers of the first have released.
  await cdp.send('HeapProfiler.collectGarbage');
  await cdp.send('HeapProfiler.collectGarbage');
  const { metrics } = await cdp.send('Performance.getMetrics');
  return (name) => metrics.find((one) => one.name === name)?.value ?? Number.NaN;
}

interface Answer {
  readonly id?: number;
  readonly result?: unknown;
  readonly error?: unknown;
}

/** Connects to the inspector of a Node process that was started with `--inspect` on this port of loopback. */
export async function inspectNode(port: number) {
  const [target] = (await (await fetch(`http://127.0.0.1:${port}/json/list`)).json()) as {
    readonly webSocketDebuggerUrl: string;
  }[];
  if (!target) throw new Error(`nothing can be inspected on port ${port}`);
  const socket = new WebSocket(target.webSocketDebuggerUrl);
  await once(socket, 'open');
  const waiting = new Map<number, (answer: Answer) => void>();
  let asked = 0;
  socket.on('message', (text) => {
    const answer = JSON.parse(String(text)) as Answer;
    if (answer.id === undefined) return;
    waiting.get(answer.id)?.(answer);
    waiting.delete(answer.id);
  });
  const ask = async (method: string, params: object = {}): Promise<unknown> => {
    asked += 1;
    const id = asked;
    const answer = await new Promise<Answer>((resolve) => {
      waiting.set(id, resolve);
      socket.send(JSON.stringify({ id, method, params }));
    });
    if (answer.error) throw new Error(`${method}: ${JSON.stringify(answer.error)}`);
    return answer.result;
  };
  return {
    /** Collects garbage and returns the memory of the process [MB]: its heap, and its resident set (`all`). */
    async memory(): Promise<{ readonly heap: number; readonly all: number }> {
      await ask('HeapProfiler.collectGarbage');
      const { result } = (await ask('Runtime.evaluate', {
        expression: 'process.memoryUsage()',
        returnByValue: true,
      })) as { readonly result: { readonly value: NodeJS.MemoryUsage } };
      return { heap: megabytes(result.value.heapUsed), all: megabytes(result.value.rss) };
    },
    close: () => socket.close(),
  };
}

export type InspectedNode = Awaited<ReturnType<typeof inspectNode>>;
