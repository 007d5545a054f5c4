type Members<Part> = Part extends object ? Part | { readonly [Name in keyof Part]?: unknown } : Part;

/**
 * Returns the members of parts of the page that a test uses in place of the whole parts. Names are checked, two levels
 * deep.
 */
export const fake = <Parts extends object>(parts: { readonly [Name in keyof Parts]?: Members<Parts[Name]> }): Parts =>
  parts as Parts;
