/** Returns the children of each node of a tree of parents; a parent that is no index belongs to a root. */
export function childrenOf(parents: readonly number[]): readonly (readonly number[])[] {
  const children: number[][] = parents.map(() => []);
  for (const [i, parent] of parents.entries()) children[parent]?.push(i);
  return children;
}

/** Returns the nodes of a tree with parents before children, without nodes in a circle or below one. */
export function parentsFirst(
  parents: readonly number[],
  children: readonly (readonly number[])[] = childrenOf(parents),
): readonly number[] {
  const order = parents.flatMap((parent, i) => (children[parent] ? [] : [i]));
  for (let i = 0; i < order.length; i++) order.push(...children[order[i]!]!);
  return order;
}
