/** The part of the Khronos validator's interface that the tests use; the package carries no types. */
declare module 'gltf-validator' {
  export function validateBytes(
    bytes: Uint8Array,
    options?: { readonly ignoredIssues?: readonly string[] },
  ): Promise<{
    readonly issues: { readonly messages: readonly { readonly severity: number; readonly message: string }[] };
    readonly info: { readonly extensionsUsed: readonly string[] };
  }>;
}
