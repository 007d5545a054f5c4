// A kind of question of a laboratory, as docs/study.md describes it: one file without imports, outside the packages.
export default ({ v, words, inLanguage, button }) => ({
  questionKinds: [
    {
      kind: 'agreement',
      schema: v.strictObject({ kind: v.literal('agreement'), yes: words(40), no: words(40) }),
      answer: () => v.picklist(['yes', 'no'], 'expected yes or no'),
      range: () => null,
      options: () => ['yes', 'no'],
      texts: ({ yes, no }) => [
        ['yes', yes],
        ['no', no],
      ],
      columns: ({ yes, no }, inWords) => ({ answers: `yes: ${inWords(yes)}; no: ${inWords(no)}` }),
      simulate: (_, part) => (part < 0.5 ? 'no' : 'yes'),
    },
  ],
  questionViews: [
    {
      kind: 'agreement',
      field: ({ yes, no }, { phrases: { language }, given, choose }) => ({
        kind: 'agreement',
        options: [
          ['yes', inLanguage(yes, language)],
          ['no', inLanguage(no, language)],
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
