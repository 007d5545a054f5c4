import type { Browser } from '@playwright/test';
import { outcomeOf } from './bench-page';

/**
 * Ways to run the learned network: our forward pass, onnxruntime-web's WebAssembly in the page's worker, its WebGPU.
 */
export const networkWays = ['plain', 'wasm', 'webgpu'] as const;
export type NetworkWay = (typeof networkWays)[number];

/** What one way costs a page that does nothing else. */
export interface NetworkCost {
  /** The execution provider, with the name of its device, which may be software; WebGPU falls back if unavailable. */
  readonly provider: string;
  /** The time of the estimate within the animation frame. */
  readonly inFrameMs: { readonly p50: number; readonly p95: number };
  /** With what is asked after the frame, on the page's thread. */
  readonly threadMs: { readonly p50: number; readonly p95: number };
  /** From the beginning of the download until a frame had the network's answer. */
  readonly firstBodyMs: number;
}

export interface MeasuredNetwork extends NetworkCost {
  /** Everything the page loaded for it, unpacked: its own code, weights, runtime. */
  readonly bytes: number;
}

/** Measures each way on a page of its own; address: of the bench's pages, served with fine clocks. */
export async function measureNetworks(
  browser: Browser,
  address: string,
): Promise<Readonly<Record<NetworkWay, MeasuredNetwork>>> {
  const costs: Partial<Record<NetworkWay, MeasuredNetwork>> = {};
  for (const way of networkWays) {
    const context = await browser.newContext({ viewport: { width: 320, height: 200 } });
    const page = await context.newPage();
    let bytes = 0;
    const arriving: Promise<void>[] = [];
    context.on('response', (response) => {
      // The browser keeps no file as large as WebGPU's runtime for those who watch it.
      const body = response.body().catch(async () => (await context.request.get(response.url())).body());
      arriving.push(
        body.then(({ length }) => {
          bytes += length;
        }),
      );
    });
    await page.goto(`${address}/networks.html?way=${way}`);
    const cost = await outcomeOf<NetworkCost>(page, 300_000);
    await Promise.all(arriving);
    costs[way] = { ...cost, bytes };
    await context.close();
  }
  return costs as Readonly<Record<NetworkWay, MeasuredNetwork>>;
}
