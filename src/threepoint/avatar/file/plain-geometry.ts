import { BufferAttribute, type InterleavedBufferAttribute, type Object3D, type TypedArray } from 'three';
import type { Steps } from '../between-frames';
import { meshesOf } from '../scene-meshes';

type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** Returns a copy of an interleaved attribute in a separate array. */
function deinterleaved(attribute: InterleavedBufferAttribute): BufferAttribute {
  const { count, itemSize, normalized, offset } = attribute;
  const { array, stride } = attribute.data;
  const plain = new (array.constructor as new (length: number) => TypedArray)(count * itemSize);
  for (let vertex = 0; vertex < count; vertex++) {
    const from = vertex * stride + offset;
    for (let item = 0; item < itemSize; item++) plain[vertex * itemSize + item] = array[from + item] as number;
  }
  return new BufferAttribute(plain, itemSize, normalized);
}

/**
 * Replaces interleaved attributes by separate arrays and adds missing indices to a scene's geometries, as the code that
 * cuts meshes into parts requires. Meshes that shared an attribute still share it.
 */
export function* makeGeometryPlain(scene: Object3D): Steps<void> {
  const known = new Map<Attribute, BufferAttribute>();
  const plain = (attribute: Attribute): BufferAttribute => {
    if (!('isInterleavedBufferAttribute' in attribute)) return attribute;
    const made = known.get(attribute) ?? deinterleaved(attribute);
    known.set(attribute, made);
    return made;
  };
  for (const { geometry } of meshesOf(scene)) {
    yield;
    for (const [name, attribute] of Object.entries(geometry.attributes)) geometry.setAttribute(name, plain(attribute));
    for (const [name, targets] of Object.entries(geometry.morphAttributes)) {
      geometry.morphAttributes[name as 'position'] = (targets as Attribute[]).map(plain);
    }
    if (!geometry.index) {
      const { count } = geometry.getAttribute('position');
      geometry.setIndex(Array.from({ length: count }, (_, index) => index));
    }
  }
}
