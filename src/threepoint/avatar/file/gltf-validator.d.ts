/** The part of the Khronos validator's interface that this project uses; the package has no types. */
declare module 'gltf-validator' {
  export function validateBytes(
    bytes: Uint8Array,
    options?: {
      readonly ignoredIssues?: readonly string[];
      /** 0 error, 1 warning, 2 information, 3 hint. */
      readonly severityOverrides?: Readonly<Record<string, number>>;
      readonly maxIssues?: number;
      readonly format?: 'glb' | 'gltf';
      readonly writeTimestamp?: boolean;
    },
  ): Promise<{
    readonly issues: {
      readonly messages: readonly {
        readonly code: string;
        readonly severity: number;
        readonly message: string;
        readonly pointer?: string;
      }[];
    };
    readonly info: { readonly extensionsUsed: readonly string[] };
  }>;
}
