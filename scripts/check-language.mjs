// node scripts/check-language.mjs [PATH …]: lists comments, titles of tests and documents that are not in plain
// technical English, by file and line. The rules are few and mechanical: they find habits, not style.
// tests/language.test.ts asserts that none is left.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import ts from 'typescript';
import { mainOf, root } from './run-command.mjs';

/** The first words of comments that are sentence fragments. */
const fragment = /^(Of|As|So|Those|Whose|Whom|Where|The same)\b/;
/** Words that replace a technical term, or that are archaic. `allowed` lists the files in which they are right. */
const unwanted = /\b(told|tells?|hears?|heard|anew|whither|in vain|to be had|believed?|of ours|whom|let go of)\b/i;
const longestSentence = 25;
/** The first words of titles that continue another title. A condition (“when …”) may complete that of its group. */
const continuation = /^(of|that|who|whom|whose|as|where|what|which|so|those|the same|and|or|but|nor)\b/i;
const longestTitle = 16;
const longestLine = 120;

/** The words that are right in a file, by file. */
const allowed = {
  'docs/study.md': /\btold\b/,
};

/** Returns the number of the line with this position of a source file. */
const lineAt = (source, position) => source.getLineAndCharacterOfPosition(position).line + 1;

/** Returns the comments of a parsed file: the line of the first character, and the text without marks. */
function commentsOfScript(source) {
  const { text } = source;
  const found = [];
  const add = (start, raw) =>
    found.push({
      line: lineAt(source, start),
      text: raw
        .replace(/^\/\*\*?|\*\/$|^\/\/\s?/g, '')
        .replace(/^\s*\* ?/gm, '')
        .trim(),
    });
  const seen = new Set();
  // Tokens are children, too: a comment before a closing bracket belongs to none of the nodes.
  const visit = (node) => {
    for (const range of ts.getLeadingCommentRanges(text, node.getFullStart()) ?? []) {
      if (seen.has(range.pos)) continue;
      seen.add(range.pos);
      add(range.pos, text.slice(range.pos, range.end));
    }
    for (const child of node.getChildren(source)) visit(child);
  };
  visit(source);
  return joined(found, text);
}

/** Joins consecutive // lines into one comment. */
function joined(comments, text) {
  const lines = text.split('\n');
  const result = [];
  for (const comment of comments.toSorted((a, b) => a.line - b.line)) {
    const last = result.at(-1);
    const isLine = /^\s*\/\//.test(lines[comment.line - 1] ?? '');
    if (last?.isLine && isLine && last.end + 1 === comment.line) {
      last.text += ` ${comment.text}`;
      last.end = comment.line;
    } else result.push({ ...comment, isLine, end: comment.line });
  }
  return result;
}

function commentsOfPython(text) {
  const found = [];
  const docstring = /"""([\s\S]*?)"""/g;
  for (const match of text.matchAll(docstring)) {
    found.push({ line: text.slice(0, match.index).split('\n').length, text: match[1].trim() });
  }
  let open = null;
  text.split('\n').forEach((line, index) => {
    const comment = /^\s*#(?!!)\s?(.*)$/.exec(line);
    if (!comment) {
      open = null;
      return;
    }
    if (open) open.text += ` ${comment[1]}`;
    else {
      open = { line: index + 1, text: comment[1] };
      found.push(open);
    }
  });
  return found;
}

function* problemsOfComments(comments) {
  for (const { line, text } of comments) {
    if (/^(biome-ignore|@ts-|reason:|noqa|type:)/.test(text)) continue;
    if (fragment.test(text)) yield { line, what: `begins with a fragment: “${text.slice(0, 60)}”` };
    const word = unwanted.exec(text);
    if (word)
      yield {
        line,
        what: `says “${word[0]}”: “${text.slice(Math.max(0, word.index - 30), word.index + 30).replaceAll('\n', ' ')}”`,
      };
  }
}

/** Yields the problems of the titles of tests and of their groups; only a test's title must begin with its subject. */
function* problemsOfTitles(source) {
  const visit = function* (node) {
    const [title] = node.arguments ?? [];
    const caller = ts.isCallExpression(node) && /^(test|it|describe)\b(.*)/.exec(node.expression.getText(source));
    if (caller && title && (ts.isStringLiteralLike(title) || ts.isTemplateExpression(title))) {
      const line = lineAt(source, title.getStart(source));
      const said = title.getText(source).slice(1, -1);
      const isGroup = caller[1] === 'describe' || caller[2].startsWith('.describe');
      if (!isGroup && continuation.test(said)) yield { line, what: `has a title without a subject: “${said}”` };
      const words = said
        .replace(/\$\{[^}]*\}/g, 'value')
        .split(/\s+/)
        .filter((part) => /^[^@]*\w/.test(part)).length;
      if (words > longestTitle) yield { line, what: `has a title of ${words} words: “${said}”` };
    }
    for (const child of node.getChildren(source)) yield* visit(child);
  };
  yield* visit(source);
}

/** Returns the problems of a Markdown file's prose; tables, code, headings and addresses of links are left out. */
function problemsOfDocument(text, file) {
  const blank = (part) => part.replace(/[^\n]/g, '');
  const prose = text
    .replace(/^```[\s\S]*?^```/gm, blank)
    .replace(/^(\||#|<).*$/gm, '')
    .replace(/\]\([^)]*\)/g, ']')
    .replace(/`[^`\n]*`/g, 'code');
  const problems = [];
  let line = 1;
  for (const paragraph of prose.split(/(\n\s*\n|\n(?=\s*(?:[-*]|\d+\.)\s))/)) {
    for (const sentence of paragraph.replace(/\n/g, ' ').split(/(?<=[.!?:;])\s+/)) {
      const words = sentence.split(/\s+/).filter((part) => /\w/.test(part)).length;
      if (words > longestSentence) {
        problems.push({ line, what: `has a sentence of ${words} words: “${sentence.trim().slice(0, 60)}…”` });
      }
      const word = unwanted.exec(sentence);
      if (word && !allowed[file]?.test(word[0])) {
        problems.push({ line, what: `says “${word[0]}”: “${sentence.trim().slice(0, 60)}…”` });
      }
    }
    line += paragraph.split('\n').length - 1;
  }
  return problems;
}

function problemsOfFile(file, text) {
  if (file.endsWith('.md')) return problemsOfDocument(text, file);
  const source = file.endsWith('.py') ? null : ts.createSourceFile(file, text, ts.ScriptTarget.Latest);
  const problems = [...problemsOfComments(source ? commentsOfScript(source) : commentsOfPython(text))];
  if (/^(tests|e2e)\/.*\.ts$/.test(file)) problems.push(...problemsOfTitles(source));
  text.split('\n').forEach((line, index) => {
    // Code is the formatters' to wrap, and an address has no place to break.
    if (line.length > longestLine && /^\s*(\*|\/\/|\/\*|#)/.test(line) && !/https?:\/\//.test(line)) {
      problems.push({ line: index + 1, what: `has ${line.length} columns` });
    }
  });
  return problems;
}

/** The files whose language is checked: neither generated files nor other authors' texts. */
const checked = /\.(tsx?|mjs|cjs|py|md)$/;
const unchecked = /^(tests\/golden\/|CHANGELOG\.md$|LICENSE|docs\/(reliability|accuracy)\.md$)/;

/** Returns every problem below these paths: {file, line, what}. */
export function languageProblems(paths = []) {
  const files = execFileSync('git', ['ls-files', '--cached', '--others', '--exclude-standard', '--', ...paths], {
    cwd: root,
    encoding: 'utf8',
  })
    .split('\n')
    .filter((file) => checked.test(file) && !unchecked.test(file));
  return files.flatMap((file) =>
    problemsOfFile(file, readFileSync(join(root, file), 'utf8')).map((problem) => ({ file, ...problem })),
  );
}

await mainOf(import.meta.url, () => {
  const problems = languageProblems(process.argv.slice(2));
  for (const { file, line, what } of problems) console.log(`${file}:${line} ${what}`);
  console.log(`${problems.length} problems`);
});
