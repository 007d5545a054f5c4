import type { BuiltInBody } from '../core/body/built-in-bodies';

/** The display names of the built-in bodies, in the order in which they are offered. */
export const bodyLabels: readonly { readonly name: BuiltInBody; readonly label: string }[] = [
  { name: 'mannequin', label: 'Mannequin' },
  { name: 'woman', label: 'Woman' },
  { name: 'man', label: 'Man' },
  { name: 'stout', label: 'Sturdy' },
  { name: 'child', label: 'Child' },
];

export const bodyLabelOf = (name: BuiltInBody): string => bodyLabels.find((body) => body.name === name)?.label ?? name;
