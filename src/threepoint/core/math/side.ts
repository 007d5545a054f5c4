/** A side of the body from the person's own view: the user's left is `left`. */
export type Side = 'left' | 'right';

export const sides = ['left', 'right'] as const satisfies readonly Side[];

export const otherSide = (side: Side): Side => (side === 'left' ? 'right' : 'left');
