/** A row of docs/reliability.md: a fault, a promise or an attack, and the tests that measure it. */
export interface Row {
  /** The fault or attack on the page, the headset or the server. */
  readonly inject: string;
  /** The result that a user, player or client must see. */
  readonly sees: string;
  readonly target: string;
  /** The figures that the page shows, by name. By default these are the first two. */
  readonly shows?: readonly string[];
  /** The test files that measure it; each reports its figures to this row. */
  readonly tests: readonly string[];
  /** The step to check by hand with a headset, with its result. */
  readonly manual?: string;
}

/** Faults of tracking and device. */
export const faultRows = {
  'head-lost': {
    inject: 'The head’s pose is null for 3 s',
    sees: 'The body freezes and fades; nothing is NaN',
    target: 'whole again within 2 frames',
    shows: ['studio'],
    tests: ['tests/threepoint/avatar/head-loss-fade.test.ts', 'e2e/page/faults.spec.ts'],
    manual: 'Cover every camera for three seconds: the world stays, the body fades and returns.',
  },
  'hand-lost': {
    inject: 'One or both hands are null or emulated',
    sees: 'The arm holds for 0.1 s, then sinks to rest; others receive the flag',
    target: 'no jump over 5 cm a frame (60 Hz)',
    tests: [
      'tests/reliability/lost-hands.test.ts',
      'tests/threepoint/core/estimation/complete-hands.test.ts',
      'e2e/page/hands.spec.ts',
    ],
    manual: 'Hold a controller behind your back for two seconds: the arm sinks and returns smoothly.',
  },
  blurred: {
    inject: '`visible-blurred` for 10 s (system menu)',
    sees: 'Drawing continues; hands rest; input is ignored',
    target: '0 throws, 0 shots',
    tests: ['tests/reliability/blurred.test.ts', 'tests/threepoint/xr/tracked-session.test.ts'],
    manual: 'Draw the bow, open the system menu, press the trigger in it, close it: no arrow has flown.',
  },
  hidden: {
    inject: 'The session is hidden for 20 s',
    sees: 'Others see “away” within 3 s; play resumes',
    target: 'within 1 s of the return',
    shows: ['“away” when it does not say so'],
    tests: ['tests/reliability/hidden.test.ts', 'tests/rooms/room/room.test.ts', 'e2e/page/entering-vr.spec.ts'],
    manual: 'Take the headset off for twenty seconds in a match: others see “away”, then you again.',
  },
  controllers: {
    inject: 'Controllers go off and on, or swap handedness',
    sees: 'Ball and bow are dropped, or follow the handedness',
    target: '0 stuck, 0 thrown or shot',
    tests: [
      'tests/reliability/controllers.test.ts',
      'tests/threepoint/xr/tracked-session.test.ts',
      'e2e/page/archery.spec.ts',
    ],
    manual: 'Take the battery out of the controller that holds a ball: the ball returns to the rack.',
  },
  'changing-hands': {
    inject: 'Controllers and hands alternate ten times while drawing',
    sees: 'The hand kind is right; the draw is cancelled',
    target: '10 of 10 cancelled, 0 shots',
    shows: ['draws cancelled', 'shots'],
    tests: [
      'tests/games/archery/gestures.test.ts',
      'tests/threepoint/xr/tracked-session.test.ts',
      'e2e/page/hands.spec.ts',
    ],
    manual: 'Lay the controllers down and take them up again while drawing.',
  },
  'space-reset': {
    inject: 'The reference space turns by 90° and moves by 1 m',
    sees: 'The world is re-anchored; others see one jump',
    target: '0 poses between the two places',
    shows: ['bodies between the two places'],
    tests: [
      'tests/reliability/space-reset.test.ts',
      'tests/rooms/client/remote-players.test.ts',
      'tests/threepoint/xr/tracked-session.test.ts',
    ],
    manual: 'Recentre while turned by a quarter: the range lies ahead at once.',
  },
  rates: {
    inject: '72 to 120 Hz, 30 % of frames dropped',
    sees: 'Arrows, balls and bodies stay the same',
    target: 'paths within 1 mm; throws within 10 cm/s',
    shows: ['throws of a hand', 'joints'],
    tests: ['tests/reliability/rates.test.ts', 'tests/games/ball/gestures.test.ts'],
    manual: 'Change the headset’s refresh rate: the built-in archer still scores 50.',
  },
  people: {
    inject: 'Heights of 1.10 to 2.20 m, seated, crouching, a floor off by 0.5 m',
    sees: 'Two seconds of calibration fit the body; a low floor prompts for the height',
    target: 'wrists 0 mm off within reach; pelvis above the floor',
    shows: ['crouching'],
    tests: ['tests/reliability/people.test.ts'],
    manual: 'Calibrate seated, then on a step, and shoot a round each time.',
  },
  flows: {
    inject: 'Left-handed, one-handed, seated, small, tall',
    sees: 'Every round of both games can be finished',
    target: '100 %',
    shows: ['archery with one hand', 'ball game'],
    tests: ['tests/reliability/flows.test.ts'],
    manual: 'Play archery with one hand (Rules and hands); hold the basket with one hand.',
  },
  comfort: {
    inject: 'Stick turns, small text, no sound, colour-blind eyes, reduced motion',
    sees: 'Snap turns with a vignette, larger text, captions, rings that differ in brightness',
    target: 'turns about the head: 0 mm; contrast 4.5 : 1',
    tests: [
      'e2e/page/desktop.spec.ts',
      'tests/reliability/comfort.test.ts',
      'tests/threepoint/xr/tracked-session.test.ts',
      'tests/page/archery/boards.test.ts',
      'tests/page/archery/archery-captions.test.ts',
      'tests/study/model/trial-log.test.ts',
    ],
    manual: 'Push a stick sideways: one step of 30°, dark edges for a moment.',
  },
  'no-headset': {
    inject: 'No WebXR, no HTTPS, a refused session',
    sees: 'A sentence with the reason, and the desktop mode',
    target: 'within 1 s',
    shows: ['session refused'],
    tests: ['tests/threepoint/xr/session-support.test.ts', 'e2e/page/faults.spec.ts'],
  },
  'graphics-lost': {
    inject: 'The WebGL context is lost and restored',
    sees: 'Everything is uploaded again; the game continues',
    target: 'a picture within 3 s',
    shows: ['archery'],
    tests: ['e2e/page/faults.spec.ts'],
    manual: 'A lost layer ends the VR session with a sentence. Enter again: the score is still there.',
  },
  'no-wasm': {
    inject: 'WASM or its worker is missing, blocked or dead',
    sees: 'IK takes over with a notice',
    target: 'the avatar moves within 2 s',
    tests: ['e2e/threepoint/models.spec.ts'],
  },
  'bad-model': {
    inject: 'A model is missing, truncated, of another hash or shape, or answers NaN',
    sees: 'IK takes over with a notice',
    target: '0 bones NaN; 1 frame',
    tests: [
      'tests/reliability/models.test.ts',
      'tests/threepoint/onnx/load-regressor.test.ts',
      'e2e/threepoint/models.spec.ts',
    ],
  },
  'webgpu-lost': {
    inject: 'The WebGPU device is lost',
    sees: 'WASM takes over, else IK',
    target: '500 ms',
    tests: ['e2e/threepoint/webgpu.spec.ts', 'e2e/threepoint/models.spec.ts'],
  },
  'clock-steps': {
    inject: 'Time stamps jump by ±5 or ±20 s and back',
    sees: 'Games, bodies, recordings and trial logs continue',
    target: 'at most 0.5 s ahead; every frame once, in order',
    shows: ['archery, -20 s and back'],
    tests: [
      'tests/reliability/clock-steps.test.ts',
      'tests/threepoint/core/tracking/page-clock.test.ts',
      'tests/rooms/client/clock-sync.test.ts',
    ],
  },
  'avatar-missing': {
    inject: 'An avatar’s address answers 404, a page, 61 MB, or a body that cannot be read',
    sees: 'Our own body stays, with a sentence and *Back to the page’s avatar*',
    target: '5 of 5 with the first picture',
    tests: ['e2e/page/avatar-address.spec.ts', 'tests/ui/limited-files.test.ts'],
  },
  'bad-input': {
    inject: 'A recording of 300 MB, button events without a frame, unknown switches',
    sees: 'One sentence; nothing is read, thrown or lost',
    target: '0 bytes read, 0 exceptions',
    tests: [
      'tests/ui/limited-files.test.ts',
      'tests/threepoint/xr/frameless-events.test.ts',
      'tests/page/shell/session/switches.test.ts',
      'tests/page/shell/session/preferences.test.ts',
    ],
  },
  'long-run': {
    inject: 'Twenty minutes of archery (nightly)',
    sees: 'Nothing grows after the first round',
    target: 'GPU objects, listeners, workers +0; heap objects +10 % at most',
    shows: ['listeners, workers', 'objects kept'],
    tests: ['e2e/page/long-run.spec.ts', 'tests/reliability/long-run.test.ts'],
    manual: 'Repeat it in the headset and read its memory with the remote inspector.',
  },
} as const satisfies Readonly<Record<string, Row>>;

/** Promises about the page, names, avatars and stored data. */
export const promiseRows = {
  policy: {
    inject: 'Foreign scripts, inline scripts, `eval`, a file on an unlisted server',
    sees: 'None runs, none is requested; all assets are our own',
    target: '0 run; 0 requests elsewhere',
    tests: ['tests/server/page.test.ts', 'e2e/page/faults.spec.ts', 'e2e/page/avatar-address.spec.ts'],
  },
  isolation: {
    inject: 'Permissions-Policy, with and without cross-origin isolation',
    sees: 'WebXR for the page alone; the same page either way',
    target: 'both load, same estimator and provider',
    shows: ['isolated'],
    tests: ['tests/server/page.test.ts', 'e2e/page/faults.spec.ts'],
  },
  text: {
    inject: 'Names and comments with markup, control characters or formulas',
    sees: 'They remain text',
    target: '0 elements made; 0 formulas in a CSV',
    tests: [
      'tests/reliability/text.test.ts',
      'e2e/rooms/foreign-text.spec.ts',
      'tests/rooms/protocol/messages.test.ts',
      'tests/study/model/tidy-csv.test.ts',
    ],
  },
  avatars: {
    inject: 'Avatar files that are too large, invalid, hostile, or name URIs',
    sees: 'A sentence with the limit; our own body stays',
    target: '100 % refused; 0 requests; VRM 0.x accepted',
    shows: ['files refused'],
    tests: ['tests/threepoint/avatar/inspect-avatar.test.ts', 'e2e/page/avatar.spec.ts'],
  },
  privacy: {
    inject: 'The server’s files and memory after a game and a study',
    sees: 'No motion without consent',
    target: '0 bytes on disk; no pose older than 2 s',
    shows: ['written while playing', 'poses handed out after 2 s'],
    tests: [
      'tests/server/privacy.test.ts',
      'tests/study/server/study-deletion.test.ts',
      'tests/study/server/study-motion.test.ts',
    ],
  },
} as const satisfies Readonly<Record<string, Row>>;

/** Attacks on the server: over the network, or by another site's page in a user's browser. */
export const attackRows = {
  'raw-requests': {
    inject: '100,000 requests by a grammar over raw sockets (1,000 by day)',
    sees: 'Each gets an answer',
    target: '0 unanswered, 0 faults, health within 50 ms',
    shows: ['without an answer', 'faults'],
    tests: ['tests/server/any-request.test.ts'],
  },
  'undecodable-paths': {
    inject: 'Paths whose percent signs encode no text, sent to the built server',
    sees: 'Each gets 400',
    target: '0 processes ended',
    tests: ['tests/server/built-server.test.ts'],
  },
  pipelines: {
    inject: '1,000,000 answers to pipelines of requests, upgrades, tunnels and garbage (4,000 by day)',
    sees: 'Each request gets its own answer in its turn, from the built server',
    target: '0 missing or out of turn, 0 processes ended',
    shows: ['answers', 'missing or out of turn', 'processes ended'],
    tests: ['tests/server/pipelined-requests.test.ts'],
  },
  'any-packet': {
    inject: '100,000 WebSocket frames by a grammar (2,000 by day)',
    sees: 'An invalid packet ends its own connection only',
    target: '0 processes ended; others are answered',
    shows: ['processes ended'],
    tests: ['tests/relay/any-packet.test.ts', 'tests/rooms/protocol/messages.test.ts'],
  },
  'hostile-player': {
    inject: 'A player forges positions and times, and changes body, voice and seat endlessly',
    sees: 'Others see plausible head speeds and few changes',
    target: '20 m/s, one leap a second; a change each 2 s after eight',
    shows: ['head, a new anchor in every packet [m/s]'],
    tests: ['tests/rooms/room/hostile-player.test.ts'],
  },
  'mutated-poses': {
    inject: '1,000,000 mutated pose packets (50,000 by day)',
    sees: 'Each arrives whole or not at all; bodies are finite',
    target: '0 exceptions, 0 unreadable frames, 0 joints NaN',
    shows: ['frames that no page can read'],
    tests: [
      'tests/rooms/room/mutated-poses.test.ts',
      'tests/rooms/room/room-faults.test.ts',
      'tests/rooms/protocol/pose-codec.test.ts',
    ],
  },
  'mutated-avatars': {
    inject: '100,000 mutated avatar files and as many FBX files (1,000 and 250 by day)',
    sees: 'A sentence that names the file, or a finite body',
    target: '0 other exceptions, 0 NaN, no file over 1 s; GLB in three times its memory, FBX holds 20 times',
    shows: ['longest work on one check [ms of the processor]', 'longest work on one FBX [ms of the processor]'],
    tests: [
      'tests/threepoint/avatar/mutated-files.test.ts',
      'tests/threepoint/avatar/mutated-fbx.test.ts',
      'tests/threepoint/avatar/fbx-work.test.ts',
      'tests/threepoint/avatar/inspect-avatar.test.ts',
    ],
  },
  'mutated-motion': {
    inject: '100,000 BVH files and as many VRM Animations with changes (2,000 and 500 by day)',
    sees: 'A sentence that names the file, or trackers within a kilometre',
    target: '0 other exceptions, 0 NaN, no file over 1 s or three times its memory',
    shows: ['longest work on one bvh [ms of the processor]'],
    tests: ['tests/threepoint/core/mocap/mutated-motion.test.ts', 'tests/threepoint/core/mocap/motion-limits.test.ts'],
  },
  crowd: {
    inject: '200 rooms of three play for ten minutes and leave, three times (20 for 5 s, twice, by day)',
    sees: 'Ticks are on time; nothing remains afterwards',
    target: 'event loop p99 20 ms on an idle machine; memory within 5 %',
    shows: ['poses delivered [%]', 'event loop p99 [ms]'],
    tests: ['tests/relay/crowded-rooms.test.ts'],
  },
  'voice-signals': {
    inject: 'A seated player signals video, data channels, a second voice or foreign addresses',
    sees: 'Room and page refuse',
    target: '0 passed on',
    tests: ['tests/rooms/protocol/messages.test.ts', 'tests/relay/voices.test.ts'],
  },
  'unwanted-bodies': {
    inject: 'A body of 200 MB for a route that takes little',
    sees: 'A refusal, then the end of the connection',
    target: 'at most the system’s buffers and 1 MiB',
    tests: ['tests/http/connection-limiter.test.ts'],
  },
  connections: {
    inject: '1,500 silent connections from one address, its limit 1,000',
    sees: 'The excess ends at once, the rest after 5 s',
    target: '0 open after that; health at most 5 ms later (p95)',
    shows: ['open after the deadline'],
    tests: ['tests/http/connection-limiter.test.ts'],
  },
  'client-addresses': {
    inject: 'One client under ever new spellings of its addresses',
    sees: 'All limits count one client; invalid values get 400',
    target: '5 of 40 joins, 256 of 300 WebSockets, at most 7 of 40 wrong tokens',
    shows: ['joins, limit 5', 'WebSockets, limit 256', 'wrong tokens checked, 5 without delay'],
    tests: ['tests/http/client-address.test.ts'],
  },
  'avatar-store': {
    inject: 'The avatar store is filled by many seats and false files',
    sees: 'A sentence; others keep their share; a seat’s files leave with it',
    target: 'a quarter for an address; nothing refused is stored',
    shows: ['stored of four files of 8 MB from one address, of 96 MB'],
    tests: ['tests/relay/avatars.test.ts', 'e2e/rooms/seen-avatars.spec.ts'],
  },
  'full-disk': {
    inject: 'The studies’ disk is full',
    sees: '507 and a sentence; writing resumes once there is room',
    target: '0 acknowledged and lost',
    tests: ['tests/study/server/study-routes.test.ts'],
  },
  'study-lock': {
    inject: 'Another program locks the database for 30 s (8 s by day)',
    sees: 'Rooms continue; reads work; writes get 503',
    target: 'event loop p99 20 ms; 0 answered 408; 0 acknowledged and lost',
    shows: ['p99 meanwhile [ms]'],
    tests: ['tests/study/server/faults/hung-database.test.ts'],
  },
  'study-disk': {
    inject: 'A flush takes 30 s (12 s by day)',
    sees: 'Rooms continue; reads work; writes get 503',
    target: 'event loop p99 20 ms; 0 answered 408; 0 acknowledged and lost',
    shows: ['p99 meanwhile [ms]'],
    tests: ['tests/study/server/faults/hung-database.test.ts'],
  },
  'study-folder': {
    inject: 'The studies’ folder is open to others, deleted, replaced, damaged, locked or newer',
    sees: 'Closed to others; 507 until it is back; a refused start names file and remedy',
    target: '0 files open to others; 0 acknowledged and lost',
    shows: ['writes acknowledged into a file that was deleted or replaced'],
    tests: ['tests/study/server/faults/study-folder.test.ts'],
  },
  'study-replays': {
    inject: 'Requests arrive twice, out of order or after revoked consent; twenty people open one link',
    sees: 'Each record is stored once; one person has the place',
    target: '0 records lost or stored twice, 1 place',
    shows: ['records stored twice or lost'],
    tests: ['tests/study/server/study-replays.test.ts'],
  },
  'study-back': {
    inject: 'Back and forward in the browser at every step of a study',
    sees: 'The study is where it was; an interrupted round is repeated',
    target: '0 records lost or stored twice',
    tests: ['e2e/study/study-back.spec.ts'],
  },
  'study-traces': {
    inject: 'Two of three participants withdraw or are deleted',
    sees: 'Nothing of theirs remains',
    target: '0 traces',
    shows: ['traces of two participants in data, logs and temporary files'],
    tests: ['tests/study/server/study-traces.test.ts'],
  },
  'storage-denied': {
    inject: 'The browser denies all storage',
    sees: 'Page, room and study work, with a notice',
    target: '0 pages fail',
    tests: ['e2e/page/storage-denied.spec.ts'],
  },
  'storage-blocked': {
    inject: 'IndexedDB alone is missing, throws, hangs or fails midway',
    sees: 'The study continues with a notice; answers reach the server',
    target: '0 sessions stopped; 0 records lost',
    tests: ['tests/study/participant/blocked-storage.test.ts'],
  },
  'first-folder': {
    inject: 'A folder of the first version, with a plan that is no longer valid',
    sees: 'Everything is read; that study takes no new participants',
    target: '0 records lost, 0 unreadable studies',
    tests: ['tests/study/server/study-migrations.test.ts'],
  },
  'study-shortage': {
    inject: 'A heap of 64 MB, no free file handles or a full disk in an export',
    sees: 'A sentence with what is short; the server continues',
    target: '0 faults, 0 acknowledged and lost',
    shows: ['disk full'],
    tests: ['tests/study/server/faults/study-shortage.test.ts'],
  },
  'server-clock': {
    inject: 'The server’s clock jumps by an hour, either way',
    sees: 'Rooms continue; passes are renewed; records keep their order',
    target: '0 players gone, 0 records refused',
    tests: ['tests/relay/server-clock.test.ts'],
  },
  'hidden-tab': {
    inject: 'A player’s tab is hidden for 12 s, 1½ min and 5½ min',
    sees: 'Others see “away”; the return is immediate',
    target: '0 seats lost, 0 errors, heap +4 MB at most',
    shows: ['hidden for 330 s'],
    tests: ['e2e/page/hidden-tab.spec.ts'],
  },
  asleep: {
    inject: 'The device sleeps for an hour in a match or a study',
    sees: 'The page returns to its seat, or to a void round; the study continues',
    target: '0 seats lost; 0 records refused',
    shows: ['both clocks go on, until its room is gone'],
    tests: ['e2e/page/asleep.spec.ts', 'tests/study/participant/asleep.test.ts'],
  },
  'study-places': {
    inject: 'Places are claimed without an invitation',
    sees: 'Each is refused with a sentence',
    target: '0 places taken',
    shows: ['places taken by 300 claims in a loop'],
    tests: ['tests/study/server/study-entry.test.ts', 'tests/study/server/study-places.test.ts'],
  },
  'other-sites': {
    inject: 'Requests with foreign origins or names that point at this machine',
    sees: 'Private reads and all changes are refused',
    target: '0 answered',
    tests: ['tests/http/site-policy.test.ts', 'tests/study/server/study-entry.test.ts', 'tests/server/access.test.ts'],
  },
  'study-rooms': {
    inject: 'A stranger searches for a trial’s room or forges a pass',
    sees: 'It is unlisted; seats are signed',
    target: '0 lists, 0 seats',
    tests: ['tests/study/server/study-rooms.test.ts'],
  },
  guessing: {
    inject: '3,000 guesses of tokens, withdrawal codes and invitations',
    sees: 'Five are examined, then one after 1, 2, 4 … s',
    target: '10 of 3,000 examined at most',
    shows: ['tokens'],
    tests: ['tests/study/server/study-entry.test.ts', 'tests/http/auth-throttle.test.ts'],
  },
  access: {
    inject: 'Every route and socket event in every role',
    sees: 'The outcome in docs/security.md',
    target: 'no route or event without a row; no cell differs',
    shows: ['cells', 'cells that differ from docs/security.md'],
    tests: ['tests/server/access.test.ts'],
  },
} as const satisfies Readonly<Record<string, Row>>;

export type RowName = keyof typeof faultRows | keyof typeof promiseRows | keyof typeof attackRows;

export const rows: Readonly<Record<RowName, Row>> = { ...faultRows, ...promiseRows, ...attackRows };
