import { PrecacheController } from 'workbox-precaching';

/**
 * Stores one whole version of the page for visits without a network. With a network the page comes from its host. If
 * the host has the stored version, the page's files come from the cache; else all of them come from the host, so that
 * no page mixes two versions. A newer version is activated when no window shows the older one. Requests to a server
 * (api, relay, studies, the experimenter's pages) are neither cached nor answered here.
 */
declare const self: ServiceWorkerGlobalScope & {
  /** Written by scripts/build-service-worker.mjs: every file with the SHA-256 of its content. */
  readonly keptFiles: readonly { readonly url: string; readonly revision: string | null; readonly integrity: string }[];
};

/** A cache with the ids of windows that show another version. Browsers often restart workers, which loses variables. */
const otherVersions = `threepoint windows ${self.registration.scope}`;

const kept = new PrecacheController({
  plugins: [
    {
      // A conditional request suffices for files that the page has just fetched: their digests are checked.
      requestWillFetch: async ({ request }) =>
        request.cache === 'reload' ? new Request(request, { cache: 'no-cache' }) : request,
    },
  ],
});
kept.addToCacheList([...self.keptFiles]);

self.addEventListener('install', (event) => {
  const installed = kept.install(event).catch(async (error: unknown) => {
    // An incomplete version is useless and may fill the storage.
    if (!self.registration.active) await caches.delete(kept.strategy.cacheName);
    throw error;
  });
  event.waitUntil(installed);
});

self.addEventListener('activate', (event) => {
  // No window is open: files of older versions and the ids of windows are deleted.
  event.waitUntil(Promise.all([kept.activate(event), caches.delete(otherVersions)]));
});

/** The time after which a host that does not answer counts as offline [ms]. */
const hostTimeoutMs = 4000;

/** Returns whether a page needs the host's files: a study, or onnxruntime-web, which is too large for the cache. */
function needsHost(address: string): boolean {
  const { searchParams } = new URL(address);
  return searchParams.has('study') || searchParams.has('ep');
}

/** Returns whether an address is the page: the folder or its index.html, with any query. */
function isThePage(address: string): boolean {
  const { origin, pathname } = new URL(address);
  const folder = self.registration.scope;
  return [folder, `${folder}index.html`].includes(origin + pathname);
}

const entryOf = (client: string): string => `${self.registration.scope}?window=${encodeURIComponent(client)}`;

async function showsOtherVersion(client: string): Promise<boolean> {
  return (await caches.match(entryOf(client), { cacheName: otherVersions })) !== undefined;
}

async function storeOtherVersion(client: string): Promise<void> {
  const entries = await caches.open(otherVersions);
  for (const entry of await entries.keys()) {
    const window = new URL(entry.url).searchParams.get('window') ?? '';
    if (!(await self.clients.get(window))) await entries.delete(entry);
  }
  await entries.put(entryOf(client), new Response());
}

/** Returns the page from its host; from the cache if the host does not answer or has the same version. */
async function pageFor({ request, resultingClientId }: FetchEvent): Promise<Response> {
  const cached = await kept.matchPrecache('index.html');
  if (!cached) return fetch(request);
  let response: Response;
  try {
    response = await fetch(request, { signal: AbortSignal.timeout(hostTimeoutMs) });
    if (response.status >= 500) return cached;
    if (response.ok && (await response.clone().text()) === (await cached.clone().text())) return response;
  } catch {
    // reason: without the host the cached page is shown
    return cached;
  }
  // Without the window's id its later requests could not be assigned to this version.
  if (!resultingClientId) return cached;
  await storeOtherVersion(resultingClientId);
  return response;
}

async function fileFor({ request, clientId }: FetchEvent): Promise<Response> {
  const page = await self.clients.get(clientId);
  if ((page && needsHost(page.url)) || (await showsOtherVersion(clientId))) return fetch(request);
  return (await kept.matchPrecache(request.url)) ?? fetch(request);
}

self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.mode === 'navigate') {
    if (isThePage(request.url) && !needsHost(request.url)) event.respondWith(pageFor(event));
  } else if (request.method === 'GET' && kept.getCacheKeyForURL(request.url)) {
    event.respondWith(fileFor(event));
  }
});
