/** The element of the page with this id; throws where index.html has lost it. */
export function pageElement<Type extends HTMLElement>(id: string, type: new () => Type): Type {
  const node = document.getElementById(id);
  if (!(node instanceof type)) throw new Error(`index.html: expected the ${type.name} with the id "${id}"`);
  return node;
}
