// The rules of imports, as drawn in docs/architecture.md. A package imports the packages that its package.json names.
// Inside a package the rules below apply. Type-only imports count too (tsPreCompilationDeps): a type from the wrong
// side is the first step of the wrong dependency.
import { readdirSync, readFileSync } from 'node:fs';

const root = new URL('.', import.meta.url);
const folders = [...readdirSync(new URL('src', root)).map((name) => `src/${name}`), 'server'];
const manifests = new Map(
  folders.map((folder) => [folder, JSON.parse(readFileSync(new URL(`${folder}/package.json`, root), 'utf8'))]),
);
const folderOf = new Map([...manifests].map(([folder, { name }]) => [name, folder]));

const packageRules = [...manifests].map(([folder, { name, dependencies = {} }]) => {
  const known = Object.keys(dependencies).flatMap((dependency) => folderOf.get(dependency) ?? []);
  return {
    name: `package-${name}`,
    comment: `${folder}/package.json names the packages of this repository that ${name} may import.`,
    severity: 'error',
    from: { path: `^${folder}/` },
    to: {
      path: '^(src|server|public)/',
      pathNot: `^(${[folder, ...known].join('|')})/${folder === 'src/threepoint' ? '|^public/models/learned\\.json$' : ''}`,
    },
  };
});

/** The modules of a package that its exports name: its entries. */
const entriesOf = (folder, { exports = {} }) =>
  Object.values(exports)
    .filter((file) => /\.tsx?$/.test(file))
    .map((file) => `${folder}/${file.slice(2)}`.replaceAll('.', '\\.'));

const entryRules = [...manifests].map(([folder, manifest]) => ({
  name: `entries-of-${manifest.name}`,
  comment:
    `Other packages and their tests import ${manifest.name} by the entries that the exports of its package.json ` +
    `name; its own tests reach into it.`,
  severity: 'error',
  from: { path: '^(src|server|tests|e2e)/', pathNot: `^(${folder}|(tests|e2e)/${folder.replace('src/', '')})/` },
  to: { path: `^${folder}/`, pathNot: `^(${entriesOf(folder, manifest).join('|') || '-'})$|\\.css$` },
}));

/** Returns the rules of a package's rooms: each room and the rooms of the package that it may import. */
const roomRules = (folder, rooms) =>
  Object.entries(rooms).map(([room, known]) => ({
    name: `${folder.replaceAll('/', '-')}-${room}`,
    comment: `${folder}/${room} may import ${known.join(', ') || 'no other room'}: anything else would let a change travel upwards.`,
    severity: 'error',
    from: { path: `^${folder}/${room}/` },
    // A module beside the rooms is for all of them.
    to: { path: `^${folder}/`, pathNot: `^${folder}/((${[room, ...known].join('|')})/|[^/]+$)` },
  }));

const coreRooms = {
  errors: [],
  validation: ['errors'],
  math: [],
  body: ['math', 'validation', 'errors'],
  humanoid: ['math', 'body'],
  input: ['math'],
  tracking: ['math', 'body', 'errors'],
  estimation: ['math', 'body', 'tracking', 'errors'],
  motion: ['math', 'body', 'tracking', 'estimation', 'errors'],
  mocap: ['math', 'body', 'humanoid', 'tracking', 'motion', 'errors'],
};
const libraryRooms = {
  core: [],
  xr: ['core'],
  avatar: ['core'],
  onnx: ['core'],
  api: ['core', 'xr', 'avatar', 'onnx'],
};
const roomsRooms = {
  protocol: [],
  room: ['protocol'],
  client: ['protocol', 'room'],
  peers: ['protocol', 'room', 'client'],
  drawing: ['protocol', 'room', 'client', 'peers'],
  react: ['drawing'],
  voices: ['protocol', 'client'],
};
const relayRooms = {
  settings: [],
  access: ['settings'],
  sockets: ['settings'],
  hosting: ['settings', 'access', 'sockets'],
  lobby: ['hosting'],
  avatars: ['settings', 'access'],
  voices: ['settings', 'access'],
};
const studyRooms = {
  statistics: [],
  model: ['statistics'],
  simulation: ['model'],
  client: ['model', 'simulation'],
  participant: ['model', 'client'],
  pages: ['model', 'statistics', 'simulation', 'client'],
  server: ['model', 'statistics'],
};
const modelRooms = {
  phrases: [],
  questionnaires: ['phrases'],
  plan: ['phrases', 'questionnaires'],
  records: ['phrases', 'questionnaires', 'plan'],
  progress: ['phrases', 'questionnaires', 'plan', 'records'],
  tables: ['phrases', 'questionnaires', 'plan', 'records'],
  results: ['questionnaires', 'plan', 'records', 'tables'],
};
const studyServerRooms = {
  sqlite: [],
  export: ['sqlite'],
  routes: ['export'],
};
const shellRooms = {
  session: [],
  stage: ['session'],
  input: ['session', 'stage'],
  panels: ['session', 'stage', 'input'],
};
/** Every file of the model is in one of its rooms. */
const knownStudyRooms = Object.keys(studyRooms).map((room) =>
  room === 'model' ? `model/(${Object.keys(modelRooms).join('|')})` : room,
);
/** The folders of the page that are no activity. */
const floors = 'activity|bones|check|embed|emulator|offline|passthrough|people|scene|shell';

/** `import 'three'` resolves into node_modules; a package that is not installed keeps its bare name. */
const packagePath = (...names) => `(^|node_modules/)(${names.join('|')})(/|$)`;

const pure =
  '^src/((threepoint/core|games|rooms/(protocol|room)|study/(model|statistics|simulation))/|(rooms/(room|host)|study/index)\\.ts$)';
const runsInNode = '^src/(http|relay|study/(server|cli))/';

export default {
  forbidden: [
    ...packageRules,
    ...entryRules,
    ...roomRules('src/threepoint/core', coreRooms),
    ...roomRules('src/threepoint', libraryRooms),
    ...roomRules('src/rooms', roomsRooms),
    ...roomRules('src/relay', relayRooms),
    ...roomRules('src/study', studyRooms),
    ...roomRules('src/study/model', modelRooms),
    ...roomRules('src/study/server', studyServerRooms),
    ...roomRules('src/page/shell', shellRooms),
    {
      name: 'rooms-are-known',
      comment: 'A new room of a package needs a line in this file that names the rooms it may import.',
      severity: 'error',
      from: {
        path: '^src/(threepoint/|rooms/|relay/|study/|page/shell/).*/',
        pathNot: `^src/(page/shell/(${Object.keys(shellRooms).join('|')})|threepoint/(${Object.keys(libraryRooms).join('|')})|rooms/(${Object.keys(roomsRooms).join('|')})|relay/(${Object.keys(relayRooms).join('|')})|study/(${knownStudyRooms.join('|')}|cli))/`,
      },
      to: {},
    },
    {
      name: 'rules-are-pure',
      comment:
        'Estimation, game rules, rooms and statistics run in the page, in the server and in tests alike: no adapter, no Node module, and of ' +
        'packages only valibot, which checks what strangers send.',
      severity: 'error',
      from: { path: pure },
      to: {
        pathNot: [pure, '^src/rooms/client/(client-policy|connection|loopback-host)\\.ts$', packagePath('valibot')],
      },
    },
    {
      name: 'library-entries-stay-apart',
      comment:
        'threepoint has neither three nor onnxruntime in it: what draws is reached through api/three alone, the runtime through api/onnx and its ' +
        'worker alone; the others take of onnx what fetches and computes without a runtime.',
      severity: 'error',
      from: {
        path: '^src/threepoint/api/',
        pathNot:
          '/(three|body-tracker|avatar-source|react|onnx|onnx-worker|polyfill|webxr|files|internal|internal-three)\\.ts$',
      },
      to: {
        path: '^src/threepoint/(xr|avatar|onnx|api/(three|body-tracker|avatar-source|react|onnx|onnx-worker))',
        pathNot:
          '^src/threepoint/(onnx/(load-plain-regressor|model-files)|avatar/file/(avatar-limits|file-hash|limited-download))\\.ts$',
      },
    },
    {
      name: 'library-polyfill-draws-nothing',
      comment:
        'threepoint/polyfill serves pages of any engine: it reads sessions, and has neither three nor a runtime.',
      severity: 'error',
      from: { path: '^src/threepoint/api/polyfill\\.ts$' },
      to: {
        path: '^src/threepoint/(avatar|onnx|xr/(?!tracked-session)|api/(three|body-tracker|avatar-source|react|onnx))',
      },
    },
    {
      name: 'library-draws-without-runtime',
      comment: 'A page that draws with threepoint/three loads no runtime: threepoint/onnx brings it.',
      severity: 'error',
      from: { path: '^src/threepoint/api/(three|body-tracker|avatar-source)\\.ts$' },
      to: {
        path: '^src/threepoint/(onnx|api/onnx)',
        pathNot: '^src/threepoint/onnx/(load-plain-regressor|model-files)\\.ts$',
      },
    },
    {
      name: 'activities-are-strangers',
      comment:
        'Each activity of the page can be removed: activities import neither each other nor the shell. They know the shell by activity/.',
      severity: 'error',
      from: { path: `^src/page/(?!(?:${floors})/)([^/]+)/` },
      to: { path: '^src/page/', pathNot: '^src/page/($1|people|scene|activity|bones)/' },
    },
    {
      name: 'shell-knows-activities-by-registry',
      comment:
        'A new game is one line of shell/activity-registry.ts: no other file of the shell or the headset check names a game.',
      severity: 'error',
      from: { path: '^src/page/(shell|activity|check)/', pathNot: '^src/page/shell/activity-registry\\.ts$' },
      to: { path: `^src/page/(?!(?:${floors}|mocap|studio)/)[^/]+/` },
    },
    {
      name: 'people-are-for-every-game',
      comment: 'page/people holds what any game of several people needs; it imports none of them.',
      severity: 'error',
      from: { path: '^src/page/people/' },
      to: { path: '^src/page/', pathNot: '^src/page/(people|activity|scene)/' },
    },
    {
      name: 'scene-draws-for-activities',
      comment: 'The scene holds what all activities draw with; it imports none of them.',
      severity: 'error',
      from: { path: '^src/page/(scene|bones|emulator|offline)/' },
      to: { path: '^src/page/', pathNot: '^src/page/$1/' },
    },
    {
      name: 'pages-apart',
      comment:
        'The headset check and the example to embed are pages of their own: no other page imports or pays for them.',
      severity: 'error',
      from: { path: '^src/(?!page/(check|embed)/)' },
      to: { path: '^src/page/(check|embed)/' },
    },
    {
      name: 'embed-is-a-stranger',
      comment:
        'The page /embed shows code that anyone can write: it imports packages by their entries, and no room of the page.',
      severity: 'error',
      from: { path: '^src/page/embed/' },
      to: { path: '^src/page/(?!embed/)' },
    },
    {
      name: 'three-draws',
      comment: "Three's vectors are live objects: they stay where things are drawn and are copied at the border.",
      severity: 'error',
      from: {
        path: '^(src|server)/',
        pathNot:
          '^src/(threepoint/(xr|avatar)|rooms/drawing|ui|page|study/participant)/|^src/threepoint/api/(body-tracker|avatar-source)\\.ts$',
      },
      to: { path: packagePath('three', '@types/three', '@pixiv/[^/]+') },
    },
    {
      name: 'onnxruntime-infers',
      comment: 'The runtime stands behind PoseRegressor, so that an estimator never knows what computes it.',
      severity: 'error',
      from: { path: '^(src|server)/', pathNot: '^src/threepoint/onnx/' },
      to: { path: packagePath('onnxruntime-[^/]+') },
    },
    {
      name: 'sqlite-stores',
      comment: 'The database stands behind StudyStorage, which routes import: another one is a folder beside this one.',
      severity: 'error',
      from: { path: '^(src|server)/', pathNot: '^src/study/server/sqlite/' },
      to: { path: packagePath('@photostructure/sqlite') },
    },
    {
      name: 'browsers-have-no-node',
      comment: "A module of Node would fail in a user's browser.",
      severity: 'error',
      from: { path: '^src/', pathNot: runsInNode },
      to: { dependencyTypes: ['core'] },
    },
    {
      name: 'browser-code-knows-no-server',
      comment: 'The page reaches the server over the network alone.',
      severity: 'error',
      from: { path: '^src/', pathNot: runsInNode },
      to: { path: runsInNode },
    },
    {
      name: 'shipped-code-knows-no-tests',
      comment: 'What ships must not need what does not.',
      severity: 'error',
      from: { path: '^(src|server)/' },
      to: { path: '^(tests|e2e|bench|scripts|tools)/' },
    },
    {
      name: 'shipped-packages-are-no-tools',
      comment:
        'A package that runs in the page or in the server is installed by npm ci --omit=dev, and audited. Exempt are types, ' +
        "peers, which the user installs, and the script that writes the plan's JSON schema.",
      severity: 'error',
      from: { path: '^(src|server)/', pathNot: '^src/study/cli/check/plan-json-schema\\.ts$' },
      to: {
        dependencyTypes: ['npm-dev'],
        dependencyTypesNot: ['type-only', 'npm-peer'],
        pathNot: packagePath('@types/[^/]+'),
      },
    },
    {
      name: 'packages-are-declared',
      comment:
        'A package that is there only because another brought it along disappears with the next update. Tests and tools use what packages declare.',
      severity: 'error',
      from: { path: '^(src|server)/' },
      to: { dependencyTypes: ['npm-no-pkg', 'npm-unknown'] },
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
  ],
  options: {
    tsPreCompilationDeps: true,
    tsConfig: { fileName: 'tsconfig.json' },
    doNotFollow: { path: 'node_modules' },
    combinedDependencies: true,
    enhancedResolveOptions: {
      exportsFields: ['exports'],
      conditionNames: ['import', 'require', 'node', 'default', 'types'],
    },
  },
};
