export type FbxNumbers = Float64Array | Float32Array | Int32Array;
export type FbxValue = number | string | Uint8Array | FbxNumbers;

export interface FbxNode {
  readonly name: string;
  readonly values: readonly FbxValue[];
  readonly children: readonly FbxNode[];
}

export const isNumbers = (value: FbxValue | undefined): value is FbxNumbers =>
  value instanceof Float64Array || value instanceof Float32Array || value instanceof Int32Array;

/** The limit of a file's numbers in lists. */
const maxNumbers = 20e6;
const maxNodes = 1e6;
const deepestNesting = 32;

/** Counts what is read of a file. Its methods throw the end of a sentence about the file if a limit is exceeded. */
export class FbxLimits {
  #numbers = 0;
  #nodes = 0;

  countNumbers(numbers: number): void {
    this.#numbers += numbers;
    if (this.#numbers > maxNumbers) throw new Error(`holds more than ${maxNumbers / 1e6} million numbers`);
  }

  countNode(depth: number): void {
    this.#nodes += 1;
    if (this.#nodes > maxNodes) throw new Error(`holds more than ${maxNodes} nodes`);
    if (depth > deepestNesting) throw new Error(`is nested deeper than ${deepestNesting} levels`);
  }
}

/** An object of a file, with the fields that have passed the check. */
export interface FbxObject {
  /** The number of the object in the checked file. */
  readonly id: number;
  /** The kind of its node, or its type where that decides: Shape, Skin, Cluster, BlendShape, BlendShapeChannel. */
  readonly kind: string;
  readonly node: FbxNode;
  /** The objects that are connected to it, but for models to models. */
  readonly below: FbxObject[];
  /** The model above a model. */
  parent?: FbxObject;
}

/** Returns a list of numbers in a node; empty: it has none of this name. */
export function listIn({ children }: FbxNode, name: string): FbxNumbers {
  const value = children.find((child) => child.name === name)?.values[0];
  return isNumbers(value) ? value : new Float64Array();
}
