/** Where a request goes. */
export interface Target {
  /** As sent: begins with one slash, percent signs and dots untouched. */
  readonly path: string;
  readonly query: URLSearchParams;
}

/** What an absolute request target begins with; a proxy sends such. */
const absolute = /^https?:\/\/[^/?#]+/i;
/** Visible ASCII but the backslash, which some clients read as a slash. */
const wellFormed = /^\/(?!\/)[!-[\]-~]*$/;

/** The target of a request line, of which nothing is believed; null: not well formed. Never throws. */
export function targetOf(url: string | undefined): Target | null {
  const origin = absolute.exec(url ?? '')?.[0];
  if (origin !== undefined && !URL.canParse(origin)) return null;
  const relative = (url ?? '').slice(origin?.length ?? 0).replace(/#.*$/s, '') || '/';
  const cut = relative.indexOf('?');
  const path = cut < 0 ? relative : relative.slice(0, cut) || '/';
  if (!wellFormed.test(path)) return null;
  try {
    decodeURIComponent(path);
  } catch (error) {
    if (error instanceof URIError) return null;
    throw error;
  }
  return { path, query: new URLSearchParams(cut < 0 ? '' : relative.slice(cut)) };
}
