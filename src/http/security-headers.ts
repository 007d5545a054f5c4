/**
 * Returns the policy of a page. Scripts are our own files and nothing evaluates text; WebAssembly may compile. Trusted
 * Types refuse text as markup or code and other addresses of scripts than those that src/ui/trusted-types.ts lets
 * through. The emulator's panels set style attributes. Textures inside a VRM become blob: URLs. `filesFrom` lists the
 * sources beyond the page's own server from which it may read files that are named by address: avatars, recordings,
 * motion capture.
 */
export const contentSecurityPolicy = (filesFrom: readonly string[]): string =>
  [
    "default-src 'self'",
    "script-src 'self' 'wasm-unsafe-eval'",
    "worker-src 'self'",
    "style-src 'self' 'unsafe-inline'",
    "img-src 'self' data: blob:",
    ["connect-src 'self' data: blob:", ...filesFrom].join(' '),
    "object-src 'none'",
    "base-uri 'none'",
    "form-action 'self'",
    "frame-ancestors 'self'",
    "require-trusted-types-for 'script'",
    'trusted-types default',
  ].join('; ');

/** Returns the policy for the device's features. */
export const permissionsPolicy = (microphone: boolean): string =>
  `xr-spatial-tracking=(self), camera=(), microphone=(${microphone ? 'self' : ''}), geolocation=()`;

/** Headers of every answer, errors included. */
export const securityHeaders: Readonly<Record<string, string>> = {
  'content-security-policy': contentSecurityPolicy([]),
  'permissions-policy': permissionsPolicy(false),
  'x-content-type-options': 'nosniff',
  'referrer-policy': 'no-referrer',
  'cross-origin-resource-policy': 'same-origin',
};
