import { FbxLimits, type FbxNode, type FbxValue } from './fbx-node';

/** A comment, a text, the name of a node, a brace, or a number or word. */
const token = /;[^\r\n]*|"([^"]*)"|([A-Za-z_]\w*):|([{}])|([^\s,{}"]+)/g;

interface OpenNode extends FbxNode {
  readonly values: FbxValue[];
  readonly children: OpenNode[];
}

function readNumbers(list: string, limits: FbxLimits): Float64Array {
  if (list.trim() === '') return new Float64Array();
  const words = list.split(',');
  limits.countNumbers(words.length);
  return Float64Array.from(words, Number);
}

/** Reads the needed nodes of FBX as text. Throws the end of a sentence about the file. */
export function readTextFbx(bytes: Uint8Array, isNeeded: (name: string) => boolean): readonly FbxNode[] {
  const text = new TextDecoder().decode(bytes);
  const version = Number(/FBXVersion: (\d+)/.exec(text)?.[1] ?? 0);
  if (!/^\s*;/.test(text) && version === 0) throw new Error('is no FBX file');
  if (version < 7000)
    throw new Error(`is FBX of version ${version / 1000}, and 7 is read; save it as FBX 2013 or later`);
  const limits = new FbxLimits();
  const root: OpenNode = { name: '', values: [], children: [] };
  const open: OpenNode[] = [root];
  let newest = root;
  token.lastIndex = 0;
  for (let found = token.exec(text); found; found = token.exec(text)) {
    const [, quoted, name, brace, word] = found;
    const parent = open.at(-1)!;
    if (brace === '{') open.push(newest);
    else if (brace === '}') {
      if (open.length > 1) newest = open.pop()!;
    } else if (name === 'a') {
      // A list of numbers is the only child of its node.
      const end = text.indexOf('}', token.lastIndex);
      if (end < 0) throw new Error('is cut short or damaged');
      if (isNeeded(parent.name)) parent.values.push(readNumbers(text.slice(token.lastIndex, end), limits));
      token.lastIndex = end;
    } else if (name !== undefined) {
      limits.countNode(open.length);
      newest = { name, values: [], children: [] };
      if (isNeeded(name)) parent.children.push(newest);
    } else if (quoted !== undefined) newest.values.push(quoted.replace(/^(\w+)::/, ''));
    // The length of a list stands before it.
    else if (word !== undefined && !word.startsWith('*'))
      newest.values.push(Number.isNaN(Number(word)) ? word : Number(word));
  }
  if (open.length > 1) throw new Error('is cut short or damaged');
  return root.children;
}
