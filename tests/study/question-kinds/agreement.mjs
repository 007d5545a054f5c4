// A kind of question of a laboratory, as docs/study.md describes it: one file without imports, outside the packages.
export default ({ v, words, inLanguage, button }) => ({
  questionKinds: [
    {
      kind: 'agreement',
      schema: v.strictObject({ kind: v.literal('agreement'), yes: words(40), no: words(40) }),
      answer: () => v.picklist([0, 1], 'expected 1 or 0'),
      range: () => [0, 1],
      options: () => null,
      texts: ({ yes, no }) => [
        ['yes', yes],
        ['no', no],
      ],
      columns: ({ yes, no }, inWords) => ({ answers: `1: ${inWords(yes)}; 0: ${inWords(no)}` }),
      simulate: (_, part) => Math.round(part),
    },
  ],
  questionViews: [
    {
      kind: 'agreement',
      field: ({ yes, no }, { phrases: { language }, given, choose }) => ({
        kind: 'agreement',
        options: [
          [1, inLanguage(yes, language)],
          [0, inLanguage(no, language)],
        ],
        answer: given,
        choose,
      }),
      // The card is built once for a question: its fields show the answer themselves.
      card: ({ options, answer, choose }) => {
        const press = (chosen) => {
          choose(chosen);
          for (const [i, [value]] of options.entries()) {
            buttons[i].setAttribute('aria-pressed', String(value === chosen));
          }
        };
        const buttons = options.map(([value, label]) =>
          button(label, () => press(value), { 'aria-pressed': String(answer === value) }),
        );
        return buttons;
      },
      sheet: {
        targets: ({ options, answer, choose }) =>
          options.map(([value, label], index) => ({
            kind: 'option',
            id: `answer-${value}`,
            label,
            look: answer === value ? 'chosen' : 'plain',
            at: [60 + index * 550, 400, 530, 150],
            act: () => choose(value),
          })),
      },
    },
  ],
});
