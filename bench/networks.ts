import type { Browser } from '@playwright/test';
import { outcomeOf, withPage } from './bench-page';

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
    costs[way] = await withPage(browser, [320, 200], async (page) => {
      const bodies: Promise<Buffer>[] = [];
      page.context().on('response', (response) => {
        // The browser does not keep a file as large as WebGPU's runtime: it is requested again.
        bodies.push(response.body().catch(async () => (await page.request.get(response.url())).body()));
      });
      await page.goto(`${address}/networks.html?way=${way}`);
      const cost = await outcomeOf<NetworkCost>(page, 300_000);
      return { ...cost, bytes: (await Promise.all(bodies)).reduce((sum, { length }) => sum + length, 0) };
    });
  }
  return costs as Readonly<Record<NetworkWay, MeasuredNetwork>>;
}
