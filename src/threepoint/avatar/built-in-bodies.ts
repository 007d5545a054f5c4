import type { OwnBody } from '../core/body/avatar-ref';

/** The display names of the project's own bodies, in the order in which they are offered. */
export const bodyLabels: readonly { readonly name: OwnBody; readonly label: string }[] = [
  { name: 'mannequin', label: 'Mannequin' },
  { name: 'woman', label: 'Woman' },
  { name: 'man', label: 'Man' },
  { name: 'stout', label: 'Stout' },
  { name: 'child', label: 'Child' },
];

export const labelOf = (name: OwnBody): string => bodyLabels.find((body) => body.name === name)?.label ?? name;
