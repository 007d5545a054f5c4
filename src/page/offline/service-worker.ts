import { PrecacheController } from 'workbox-precaching';

/**
 * Keeps one whole version of the page for visits without a network. With a network the page comes from its host as
 * ever: where that has the very version that is kept, the page's files come from here, else all of them come from the
 * host. So no page has files of two versions, and a newer version, once it is here whole, waits until no window has the
 * older one. What is asked of a server (api, relay, studies, the experimenter's pages) is neither kept nor answered
 * here.
 */
declare const self: ServiceWorkerGlobalScope & {
  /** Written by scripts/build-service-worker.mjs: every file with the SHA-256 of its content. */
  readonly keptFiles: readonly { readonly url: string; readonly revision: string | null; readonly integrity: string }[];
};

/**
 * The ids of windows whose page is another version than the stored one. They are stored, because browsers often restart
 * workers.
 */
const strangersCache = `threepoint windows ${self.registration.scope}`;

const kept = new PrecacheController({
  plugins: [
    {
      // What the page has just fetched is asked for again in a word: whether it is still the same. Its digest is
      // checked in any case.
      requestWillFetch: async ({ request }) =>
        request.cache === 'reload' ? new Request(request, { cache: 'no-cache' }) : request,
    },
  ],
});
kept.addToCacheList([...self.keptFiles]);

self.addEventListener('install', (event) => {
  const installed = kept.install(event).catch(async (error: unknown) => {
    // Half a version is of no use, and the storage may be full because of it.
    if (!self.registration.active) await caches.delete(kept.strategy.cacheName);
    throw error;
  });
  event.waitUntil(installed);
});

self.addEventListener('activate', (event) => {
  // Files of older versions go, and the notes on windows: none is open.
  event.waitUntil(Promise.all([kept.activate(event), caches.delete(strangersCache)]));
});

/** The time after which a host that does not answer counts as offline [ms]. */
const patienceMs = 4000;

/**
 * A study runs on what its server serves now; what computes by WebGPU is too large to be kept, and must fit its page.
 */
function asksForServer(address: string): boolean {
  const { searchParams } = new URL(address);
  return searchParams.has('study') || searchParams.get('ep') === 'webgpu';
}

/** The folder itself and its index.html, with any query. */
function isThePage(address: string): boolean {
  const { origin, pathname } = new URL(address);
  const folder = self.registration.scope;
  return [folder, `${folder}index.html`].includes(origin + pathname);
}

const noteOf = (client: string): string => `${self.registration.scope}?window=${encodeURIComponent(client)}`;

async function isStranger(client: string): Promise<boolean> {
  return (await caches.match(noteOf(client), { cacheName: strangersCache })) !== undefined;
}

async function noteStranger(client: string): Promise<void> {
  const notes = await caches.open(strangersCache);
  for (const note of await notes.keys()) {
    const noted = new URL(note.url).searchParams.get('window') ?? '';
    if (!(await self.clients.get(noted))) await notes.delete(note);
  }
  await notes.put(noteOf(client), new Response());
}

/** The page from its host; from here where that is away. */
async function pageFor({ request, resultingClientId }: FetchEvent): Promise<Response> {
  const own = await kept.matchPrecache('index.html');
  if (!own) return fetch(request);
  let answer: Response;
  try {
    answer = await fetch(request, { signal: AbortSignal.timeout(patienceMs) });
    if (answer.status >= 500) return own;
    if (answer.ok && (await answer.clone().text()) === (await own.clone().text())) return answer;
  } catch {
    // reason: a host that is away is what the copy is for
    return own;
  }
  // If a browser does not name the window of a navigation, its later requests cannot be assigned to it.
  if (!resultingClientId) return own;
  await noteStranger(resultingClientId);
  return answer;
}

async function fileFor({ request, clientId }: FetchEvent): Promise<Response> {
  const page = await self.clients.get(clientId);
  if ((page && asksForServer(page.url)) || (await isStranger(clientId))) return fetch(request);
  return (await kept.matchPrecache(request.url)) ?? fetch(request);
}

self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.mode === 'navigate') {
    if (isThePage(request.url) && !asksForServer(request.url)) event.respondWith(pageFor(event));
  } else if (request.method === 'GET' && kept.getCacheKeyForURL(request.url)) {
    event.respondWith(fileFor(event));
  }
});
