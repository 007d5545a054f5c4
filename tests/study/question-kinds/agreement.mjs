// A kind of question of a laboratory, as docs/study.md describes it: one file without imports, outside the packages.
export default ({ v, words, inLanguage, h }) => ({
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
      card: ({ options, answer, choose }) =>
        options.map(([value, label]) => {
          const attributes = { type: 'button', 'aria-pressed': answer === value, onClick: () => choose(value) };
          return h('button', attributes, label);
        }),
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
