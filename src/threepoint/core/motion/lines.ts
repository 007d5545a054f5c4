const maxShown = 40;
/** The longest line of a motion file [characters]. */
const longestLine = 2 ** 20;
/** The largest number of a motion file: a thousand kilometres in millimetres. */
const largestNumber = 1e9;

/** Returns a text of a file in quotes, shortened, for messages. */
export const shown = (text: string): string => `“${text.length > maxShown ? `${text.slice(0, maxShown)}…` : text}”`;

/** A word of a line and the column [from 1] at which it begins. */
export interface Word {
  readonly word: string;
  readonly column: number;
}

/** Reads the lines of a text one by one, and reports the place of faults. */
export class Lines {
  /** The number of the current line, from 1. */
  number = 0;
  line = '';
  /** Whether a number was written with a comma for its decimals. */
  commas = false;
  #next = 0;
  readonly text: string;
  readonly #separator: string;

  constructor(text: string) {
    // Editors of Windows begin a file with a byte order mark; old programs end lines with CR alone.
    this.text = text.startsWith('\ufeff') ? text.slice(1) : text;
    this.#separator = this.text.includes('\n') ? '\n' : '\r';
  }

  /** The fraction [0, 1] of the text that was read. */
  get fraction(): number {
    return this.text.length === 0 ? 1 : Math.min(1, this.#next / this.text.length);
  }

  /** Advances to the next line that is neither blank nor a comment after `#`; returns false if there is none. */
  next(): boolean {
    while (this.#next <= this.text.length) {
      const feed = this.text.indexOf(this.#separator, this.#next);
      const end = feed < 0 ? this.text.length : feed;
      this.number += 1;
      if (end - this.#next > longestLine) this.fail(longestLine, 'the line does not end: this is no motion file');
      this.line = this.text.slice(this.#next, end);
      this.#next = end + 1;
      if (!/^\s*(#|$)/.test(this.line)) return true;
    }
    return false;
  }

  /** Returns the words of the line. `comment`: whether `#` begins a comment, which is left out. */
  words(comment = false): readonly Word[] {
    const line = comment ? this.line.split('#', 1)[0]! : this.line;
    return [...line.matchAll(/\S+/g)].map(({ 0: word, index }) => ({ word, column: index + 1 }));
  }

  /** Returns the number that a word stands for; NaN: it is no finite number. */
  parse(word: string): number {
    // Number takes '0x10' and 'Infinity' too; the latter is no finite number.
    const value = Number(word);
    if (Number.isFinite(value)) return value;
    const decimal = /^[+-]?\d*,\d+(e[+-]?\d+)?$/i.test(word) ? Number(word.replace(',', '.')) : Number.NaN;
    if (!Number.isFinite(decimal)) return Number.NaN;
    this.commas = true;
    return decimal;
  }

  /** Returns the number that a word stands for; throws where it is no finite number, or too large for any motion. */
  numberOf({ word, column }: Word): number {
    const value = this.parse(word);
    if (Number.isNaN(value)) this.fail(column, `${shown(word)} is no finite number`);
    if (Math.abs(value) > largestNumber)
      this.fail(column, `${shown(word)} is too large; ${largestNumber} is the limit`);
    return value;
  }

  /** Writes the numbers of the line from a character on, as many as `width` at most; returns how many there are. */
  numbers(from: number, target: Float64Array, at: number, width: number): number {
    const { line } = this;
    let count = 0;
    for (let i = from; i < line.length; ) {
      if (line.charCodeAt(i) <= 32) {
        i++;
        continue;
      }
      let end = i + 1;
      while (end < line.length && line.charCodeAt(end) > 32) end++;
      const word = line.slice(i, end);
      let value = Number(word);
      if (!(Math.abs(value) <= largestNumber)) value = this.numberOf({ word, column: i + 1 });
      if (count < width) target[at + count] = value;
      count += 1;
      i = end;
    }
    return count;
  }

  fail(column: number, message: string): never {
    throw new Error(`line ${this.number}, column ${column}: ${message}`);
  }
}

/** A growing table of rows of `width` numbers. */
export class Rows {
  values: Float64Array;
  count = 0;

  constructor(readonly width: number) {
    this.values = new Float64Array(width * 64);
  }

  /** Makes room for another row of zeros; returns where it begins. */
  add(): number {
    const at = this.count * this.width;
    if (at + this.width > this.values.length) {
      const larger = new Float64Array(2 * this.values.length);
      larger.set(this.values);
      this.values = larger;
    }
    this.count += 1;
    return at;
  }

  drop(): void {
    this.count -= 1;
  }

  finish(): Float64Array {
    return this.values.subarray(0, this.count * this.width);
  }
}
