import { pageFolder } from './page-folder';

interface TrustedTypes {
  createPolicy(name: 'default', rules: { createScriptURL(address: string): string | null }): unknown;
}

/** Returns the address of a script where it is a file of the page's own build, else null. */
export function ownScriptAddress(address: string, folder: string): string | null {
  const { href } = new URL(address, `${folder}/`);
  return href.startsWith(`${folder}/assets/`) || href === `${folder}/sw.js` ? href : null;
}

/**
 * Lets workers and the service worker be made from the page's own files. Under the server's policy
 * (require-trusted-types-for) a browser refuses every other address of a script, and any text as markup or code.
 * Browsers without Trusted Types have the rest of the policy.
 */
export function installTrustedTypesPolicy(): void {
  const { trustedTypes } = globalThis as { readonly trustedTypes?: TrustedTypes };
  trustedTypes?.createPolicy('default', { createScriptURL: (address) => ownScriptAddress(address, pageFolder()) });
}
