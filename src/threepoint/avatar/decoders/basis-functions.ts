/** The type of a C++ argument or result in embind. */
interface WireType {
  readonly isVoid?: boolean;
  readonly argPackAdvance: number;
  toWireType(destructors: unknown[] | null, value: unknown): unknown;
  fromWireType(value: unknown): unknown;
  readValueFromPointer(pointer: number): unknown;
}

type Call = (...given: unknown[]) => unknown;
/** Takes the values that a text's names stand for, and makes the function that the text describes. */
type Maker = (...values: never[]) => Call;

const numbered = (count: number, prefix: string, suffix = ''): string[] =>
  Array.from({ length: count }, (_, i) => `${prefix}${i}${suffix}`);

/** What an invoker's text says beside the number of its arguments. */
interface InvokerKind {
  readonly count: number;
  readonly ofObject: boolean;
  readonly stacked: boolean;
  readonly returns: boolean;
  /** Wired arguments that are destroyed one by one. */
  readonly destroyed: readonly string[];
}

/** The text that embind writes of a function that calls C++, to the letter. */
function invokerText({ count, ofObject, stacked, returns, destroyed }: InvokerKind): string {
  const stack = stacked ? 'destructors' : 'null';
  const wired = [...(ofObject ? ['thisWired'] : []), ...numbered(count, 'arg', 'Wired')];
  return [
    `\n        return function (${numbered(count, 'arg').join(', ')}) {\n        if (arguments.length !== ${count}) {\n`,
    `          throwBindingError('function ' + humanName + ' called with ' + arguments.length + ' arguments, expected ${count}');\n        }`,
    stacked ? 'var destructors = [];\n' : '',
    ofObject ? `var thisWired = classParam['toWireType'](${stack}, this);\n` : '',
    ...numbered(count, '').map((i) => `var arg${i}Wired = argType${i}['toWireType'](${stack}, arg${i});\n`),
    `${returns ? 'var rv = ' : ''}invoker(${['fn', ...wired].join(', ')});\n`,
    stacked ? 'runDestructors(destructors);\n' : '',
    ...destroyed.map((name) => `${name}_dtor(${name});\n`),
    returns ? "var ret = retType['fromWireType'](rv);\nreturn ret;\n" : '',
    '}\n',
  ].join('');
}

const invokerNames = ['humanName', 'throwBindingError', 'invoker', 'fn', 'runDestructors', 'retType', 'classParam'];
const destructor = /^(\w+)_dtor$/;

/** A function that calls C++; null: the text is none. */
function invokerOf(names: readonly string[], text: string): Maker | null {
  const count = names.filter((name) => name.startsWith('argType')).length;
  const destroyed = names.flatMap((name) => destructor.exec(name)?.[1] ?? []);
  const kind: InvokerKind = {
    count,
    ofObject: text.includes('var thisWired'),
    stacked: text.includes('var destructors'),
    returns: text.includes('return ret;'),
    destroyed,
  };
  const known = [...invokerNames, ...numbered(count, 'argType'), ...destroyed.map((name) => `${name}_dtor`)];
  if (names.join() !== known.join() || text !== invokerText(kind)) return null;
  const wiredNames = [...(kind.ofObject ? ['thisWired'] : []), ...numbered(count, 'arg', 'Wired')];
  return (
    humanName: string,
    throwBindingError: (message: string) => never,
    invoker: Call,
    fn: unknown,
    runDestructors: (destructors: unknown[]) => void,
    retType: WireType,
    classParam: WireType,
    ...rest: unknown[]
  ) => {
    const types = rest.slice(0, count) as WireType[];
    const destructors = rest.slice(count) as Call[];
    return function (this: unknown, ...given) {
      if (given.length !== count) {
        throwBindingError(`function ${humanName} called with ${given.length} arguments, expected ${count}`);
      }
      const stack: unknown[] | null = kind.stacked ? [] : null;
      const wired = [
        ...(kind.ofObject ? [classParam.toWireType(stack, this)] : []),
        ...types.map((type, i) => type.toWireType(stack, given[i])),
      ];
      const result = invoker(fn, ...wired);
      if (stack) runDestructors(stack);
      for (const [i, destroy] of destructors.entries()) destroy(wired[wiredNames.indexOf(destroyed[i]!)]);
      return kind.returns ? retType.fromWireType(result) : undefined;
    };
  };
}

/** The text that embind writes of a function by which C++ calls a method or a constructor of JavaScript, to the letter. */
function callerText(count: number, constructs: boolean, returns: boolean, packed: number): string {
  const given = [...(constructs ? [] : ['obj']), ...numbered(count, 'arg')];
  return [
    'return function (obj, func, destructorsRef, args) {\n',
    ...numbered(count, '').map(
      (i) => `  var arg${i} = argType${i}.readValueFromPointer(args${i === '0' ? '' : `+${packed * Number(i)}`});\n`,
    ),
    `  var rv = ${constructs ? 'new func' : 'func.call'}(${given.join(', ')});\n`,
    returns ? '  return emval_returnValue(retType, destructorsRef, rv);\n' : '',
    '};\n',
  ].join('');
}

/** The size [bytes] of a packed argument in embind. */
const packedBytes = 8;

/** A function by which C++ calls JavaScript; null: the text is none. */
function callerOf(names: readonly string[], text: string): Maker | null {
  const count = names.filter((name) => name.startsWith('argType')).length;
  const returns = names.includes('emval_returnValue');
  const constructs = text.includes('new func(');
  const known = ['retType', ...numbered(count, 'argType'), ...(returns ? ['emval_returnValue'] : [])];
  if (names.join() !== known.join() || text !== callerText(count, constructs, returns, packedBytes)) return null;
  return (retType: WireType, ...rest: unknown[]) => {
    const types = rest.slice(0, count) as WireType[];
    const returnValue = rest[count] as Call | undefined;
    return (object, called, destructorsRef, packed) => {
      const given = types.map((type, i) => type.readValueFromPointer((packed as number) + packedBytes * i));
      const result = constructs
        ? Reflect.construct(called as never, given)
        : Reflect.apply(called as never, object, given);
      return returnValue?.(retType, destructorsRef, result);
    };
  };
}

/**
 * What the Basis transcoder calls `Function`, for a worker whose policy forbids to compile text: the texts that its embind writes are known,
 * and functions of values do what each says. Another text is refused.
 */
export function functionOfText(...texts: string[]): Maker {
  const names = texts.slice(0, -1);
  const text = texts.at(-1) ?? '';
  const maker = invokerOf(names, text) ?? callerOf(names, text);
  if (!maker)
    throw new Error(`the Basis transcoder wants a function of a text that is not known: ${text.slice(0, 120)}`);
  return maker;
}

// `instanceof Function` holds of every function all the same.
functionOfText.prototype = Function.prototype;
