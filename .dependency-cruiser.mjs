// Who may import whom (docs: the design's "Who may import whom"). Every rule says in its comment what it protects.
// Type-only imports count too (tsPreCompilationDeps): a type from the wrong side is the first step of the wrong dependency.

/** Each folder of core and the folders of core it may know, from the ground up. */
const coreFolders = {
  errors: [],
  math: [],
  body: ['math'],
  tracking: ['math', 'body', 'errors'],
  estimation: ['math', 'body', 'tracking', 'errors'],
  motion: ['math', 'body', 'tracking', 'estimation', 'errors'],
  mocap: ['math', 'body', 'tracking', 'motion', 'errors'],
  games: ['math', 'tracking'],
  protocol: ['math', 'body', 'tracking', 'games'],
  room: ['math', 'body', 'tracking', 'protocol', 'errors'],
  'match-policies': ['math', 'games', 'protocol', 'room'],
  statistics: ['math'],
  study: ['math', 'body', 'tracking', 'estimation', 'protocol', 'statistics', 'errors'],
  rehearsal: ['math', 'study'],
};

const coreRules = Object.entries(coreFolders).map(([folder, known]) => ({
  name: `core-${folder}`,
  comment:
    known.length === 0
      ? `core/${folder} is the ground everything stands on: it knows nothing else.`
      : `core/${folder} may know ${known.join(', ')}; anything else would let a change travel upwards.`,
  severity: 'error',
  from: { path: `^src/core/${folder}/` },
  to: { path: '^src/core/', pathNot: `^src/core/(${[folder, ...known].join('|')})/` },
}));

/** `import 'three'` resolves into node_modules; a package that is not installed keeps its bare name. */
const packagePath = (...names) => `(^|node_modules/)(${names.join('|')})(/|$)`;

const adapters = 'xr|inference|avatar|scene|net|ui';
const testsAndTools = '^(tests|e2e|bench|scripts)/';

export default {
  forbidden: [
    ...coreRules,
    {
      name: 'core-folders-are-known',
      comment: 'A new folder in core needs a line in this file that says whom it may know.',
      severity: 'error',
      from: { path: '^src/core/', pathNot: `^src/core/(${Object.keys(coreFolders).join('|')})/` },
      to: {},
    },
    {
      name: 'core-is-pure',
      comment:
        'core runs in the page, in the server and in tests alike: no package, no Node module and no adapter, so that it ' +
        'can neither draw nor wait nor ask the time.',
      severity: 'error',
      from: {
        path: '^src/core/',
        pathNot:
          '^src/core/(study|statistics)/|^src/core/protocol/(messages|ball-messages|ball-snapshot|voice-messages)\\.ts$',
      },
      to: { pathNot: '^src/core/' },
    },
    {
      name: 'core-messages-are-checked',
      comment: 'As core-is-pure, with valibot: messages arrive from strangers and are checked field by field.',
      severity: 'error',
      from: { path: '^src/core/protocol/(messages|ball-messages|ball-snapshot|voice-messages)\\.ts$' },
      to: { pathNot: ['^src/core/', packagePath('valibot')] },
    },
    {
      name: 'core-study-is-pure',
      comment:
        'As core-is-pure, with valibot, a function of its arguments alone: study files and records arrive from outside, and errors ' +
        'must name the field.',
      severity: 'error',
      from: { path: '^src/core/study/' },
      to: { pathNot: ['^src/core/', packagePath('valibot')] },
    },
    {
      name: 'core-statistics-is-pure',
      comment:
        'As core-is-pure, with the distribution functions of stdlib: p-values belong to a library that agrees with R.',
      severity: 'error',
      from: { path: '^src/core/statistics/' },
      to: { pathNot: ['^src/core/', packagePath('@stdlib/(stats-base-dists|math-base-special)-[^/]+')] },
    },
    {
      name: 'library-knows-no-page',
      comment:
        'src/lib is the public face: it introduces core, inference, xr, avatar and scene to each other, and the page is one of its consumers. ' +
        "Of public/ it brings the learned network's contract.",
      severity: 'error',
      from: { path: '^src/lib/' },
      to: {
        path: '^(src|server|public)/',
        pathNot: '^src/(lib|core|inference|xr|avatar|scene)/|^public/models/learned\\.json$',
      },
    },
    {
      name: 'library-parts-stay-apart',
      comment:
        'threepoint has neither three nor onnxruntime in it: what draws is reached through lib/three alone, the runtime through lib/onnx ' +
        'and its worker alone; of inference the others take what fetches and computes without a runtime.',
      severity: 'error',
      from: { path: '^src/lib/', pathNot: '^src/lib/(three|onnx|onnx-worker|polyfill)\\.ts$' },
      to: {
        path: '^src/(xr|avatar|scene|inference|lib/(three|onnx|onnx-worker))',
        pathNot: '^src/inference/(load-plain-regressor|model-files)\\.ts$',
      },
    },
    {
      name: 'library-polyfill-draws-nothing',
      comment:
        'threepoint/polyfill serves pages of any engine: it reads sessions, and has neither three nor a runtime.',
      severity: 'error',
      from: { path: '^src/lib/polyfill\\.ts$' },
      to: { path: '^src/(avatar|scene|inference|xr/(?!tracker)|lib/(three|onnx|onnx-worker))' },
    },
    {
      name: 'library-draws-without-runtime',
      comment: 'Who draws with threepoint/three serves no runtime: it is threepoint/onnx that brings it.',
      severity: 'error',
      from: { path: '^src/lib/three\\.ts$' },
      to: {
        path: '^src/(inference|lib/onnx)',
        pathNot: '^src/inference/(load-plain-regressor|model-files)\\.ts$',
      },
    },
    {
      name: 'room-reaches-no-game',
      comment:
        'The Room hosts any game: what is particular to one comes in as its MatchPolicy, not through a third module either.',
      severity: 'error',
      from: { path: '^src/core/room/' },
      to: { path: '^src/core/games/', reachable: true },
    },
    {
      name: 'adapters-are-strangers',
      comment:
        'Adapters (one per outside thing) never know each other, or replacing one would mean changing another: the page ' +
        'introduces them. All may use scene.',
      severity: 'error',
      from: { path: `^src/(${adapters})/` },
      to: { path: `^src/(${adapters})/`, pathNot: '^src/($1|scene)/' },
    },
    {
      name: 'nothing-loose-in-src',
      comment: 'A file belongs to a room, and the room says whom it may know.',
      severity: 'error',
      from: { path: `^src/(?!(core|${adapters}|lib|app|pages|styles)/)` },
      to: {},
    },
    {
      name: 'adapters-know-no-page',
      comment: 'Core and adapters are used by the library and by pages; they know neither.',
      severity: 'error',
      from: { path: `^src/(core|${adapters})/` },
      to: { path: '^src/(app|pages|lib)/' },
    },
    {
      name: 'activities-are-strangers',
      comment:
        'A game, the studio, motion capture and the study can each be taken away: they know neither each other nor the shell, which introduces them.',
      severity: 'error',
      from: { path: '^src/app/(archery|ball|mocap|study|studio)/' },
      to: { path: '^src/app/', pathNot: '^src/app/$1/' },
    },
    {
      name: 'main-is-imported-by-none',
      comment: 'main.ts builds everything; who needs something from it should be given it.',
      severity: 'error',
      from: {},
      to: { path: '^src/app/main\\.ts$' },
    },
    {
      name: 'pages-stand-alone',
      comment:
        "The experimenter's and the results page load in a moment: nothing of the body, the games or the page that plays them.",
      severity: 'error',
      from: { path: '^src/pages/' },
      to: { path: '^src/', pathNot: '^src/(pages|core|net|ui|styles)/' },
    },
    {
      name: 'three-draws',
      comment: "Three's vectors are live objects: they stay where things are drawn and are copied at the border.",
      severity: 'error',
      from: { path: '^(src|server)/', pathNot: '^src/(xr|avatar|scene|ui|app)/|^src/lib/three\\.ts$' },
      to: { path: packagePath('three', '@types/three', '@pixiv/[^/]+') },
    },
    {
      name: 'onnxruntime-infers',
      comment: 'The runtime stands behind PoseRegressor, so that an estimator never knows what computes it.',
      severity: 'error',
      from: { path: '^(src|server)/', pathNot: '^src/inference/' },
      to: { path: packagePath('onnxruntime-[^/]+') },
    },
    {
      name: 'socket-io-connects',
      comment: 'The Room and the games know no socket: offline play is the same code.',
      severity: 'error',
      from: { path: '^(src|server)/', pathNot: '^(src/net|server)/' },
      to: { path: packagePath('socket\\.io[^/]*', '@socket\\.io/[^/]+') },
    },
    {
      name: 'sqlite-stores',
      comment:
        'The database stands behind StudyStore, so that another one (or the Node module, once we need no Node 20) is one file.',
      severity: 'error',
      from: { path: '^(src|server)/', pathNot: '^server/study-(database|schema)\\.ts$' },
      to: { path: packagePath('@photostructure/sqlite') },
    },
    {
      name: 'server-knows-core-alone',
      comment: 'The server shares the rules with the page, not the page: nothing that draws belongs in it.',
      severity: 'error',
      from: { path: '^server/' },
      to: { path: '^src/', pathNot: '^src/core/' },
    },
    {
      name: 'page-knows-no-server',
      comment: 'The page reaches the server over the network alone.',
      severity: 'error',
      from: { path: '^src/' },
      to: { path: '^server/' },
    },
    {
      name: 'shipped-code-knows-no-tests',
      comment: 'What ships must not need what does not.',
      severity: 'error',
      from: { path: '^(src|server)/' },
      to: { path: testsAndTools },
    },
    {
      name: 'page-runs-in-a-browser',
      comment: "The page has no Node: a built-in module here would only fail in a user's browser.",
      severity: 'error',
      from: { path: '^src/' },
      to: { dependencyTypes: ['core'] },
    },
    {
      name: 'no-cycles',
      comment: 'Modules in a circle cannot be understood, tested or moved one at a time.',
      severity: 'error',
      from: {},
      to: { circular: true },
    },
    {
      name: 'imports-resolve',
      comment: 'An import that leads nowhere fails at build time at best.',
      severity: 'error',
      from: {},
      to: { couldNotResolve: true },
    },
    {
      name: 'shipped-packages-are-no-tools',
      comment:
        'A package that runs in the page or in the server is installed by npm ci --omit=dev, and audited. Type packages are exempt, and so are the ' +
        'loaders by which threads run from source: the built server has none (scripts/build-server.mjs).',
      severity: 'error',
      from: { path: '^(src|server)/', pathNot: '^server/[^/]+-worker\\.mjs$' },
      to: { dependencyTypes: ['npm-dev'], dependencyTypesNot: ['type-only'], pathNot: packagePath('@types/[^/]+') },
    },
    {
      name: 'packages-are-declared',
      comment: 'A package that is there only because another brought it along disappears with the next update.',
      severity: 'error',
      from: { path: '^(src|server|tests|e2e|bench)/' },
      to: { dependencyTypes: ['npm-no-pkg', 'npm-unknown'] },
    },
  ],
  options: {
    tsPreCompilationDeps: true,
    tsConfig: { fileName: 'tsconfig.json' },
    doNotFollow: { path: 'node_modules' },
    enhancedResolveOptions: {
      exportsFields: ['exports'],
      conditionNames: ['import', 'require', 'node', 'default', 'types'],
    },
  },
};
