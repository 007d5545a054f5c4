/** A row of docs/reliability.md: a fault, a promise or an attack, and the tests that measure it. */
export interface Row {
  /** The fault or attack on the page, the headset or the server. */
  readonly inject: string;
  /** The result that a user, player or client must see. */
  readonly sees: string;
  readonly target: string;
  /** The test files that measure it; each reports its figures to this row. */
  readonly tests: readonly string[];
  /** The steps to check by hand with a headset. */
  readonly manual?: readonly string[];
}

/** Faults of tracking and device. */
export const faultRows = {
  'head-lost': {
    inject: 'The pose of the head is null for 3 s',
    sees: 'The body freezes and fades; nothing is NaN',
    target: 'no exception; whole again within 2 frames',
    tests: ['tests/threepoint/avatar/head-loss.test.ts', 'e2e/page/faults.spec.ts'],
    manual: [
      'Walk out of the guardian, or cover every camera for three seconds: the world stays, the body fades and returns.',
    ],
  },
  'hand-lost': {
    inject: 'One or both hands null or emulated',
    sees: 'The arm is held for 0.1 s and sinks to rest in 2.5 s; the flag travels to others',
    target: 'no jump over 5 cm per frame (60 Hz), 200 ms blend',
    tests: [
      'tests/reliability/lost-hands.test.ts',
      'tests/threepoint/core/estimation/complete-hands.test.ts',
      'e2e/page/hands.spec.ts',
    ],
    manual: [
      'Put one controller behind your back for two seconds and bring it back: the arm sinks and returns smoothly.',
    ],
  },
  blurred: {
    inject: '`visible-blurred` for 10 s: a menu of the system lies before the page',
    sees: 'Drawing goes on, hands rest, input is ignored, nothing is dropped',
    target: 'no exception; 0 throws and shots released',
    tests: ['tests/reliability/blurred.test.ts', 'tests/threepoint/xr/tracked-session.test.ts'],
    manual: ['Draw the bow, open the system menu, press the trigger in it, close it: no arrow has flown.'],
  },
  hidden: {
    inject: 'Hidden for 20 s, the headset taken off',
    sees: 'Others see “away” within 3 s; play resumes',
    target: 'within 1 s of the return',
    tests: ['tests/reliability/hidden.test.ts', 'tests/rooms/room/room.test.ts', 'e2e/page/entering-vr.spec.ts'],
    manual: [
      'Take the headset off for twenty seconds in a ball game with another player: they see “away”; put it on: they see you.',
    ],
  },
  controllers: {
    inject: 'A controller off and on, both off, their handedness swapped while holding',
    sees: 'Ball and bow are let go of or taken over by handedness',
    target: '0 stuck in a hand, 0 thrown or shot',
    tests: [
      'tests/reliability/controllers.test.ts',
      'tests/threepoint/xr/tracked-session.test.ts',
      'e2e/page/archery.spec.ts',
    ],
    manual: ['Take a battery out of the controller that holds a ball: the ball goes back to the rack.'],
  },
  'changing-hands': {
    inject: 'Controllers → hands → controllers, ten times while drawing',
    sees: 'The right kind each time, the draw cancelled',
    target: '10 of 10 cancelled, 0 shots, 0 leaks',
    tests: [
      'tests/reliability/controllers.test.ts',
      'tests/threepoint/xr/tracked-session.test.ts',
      'e2e/page/hands.spec.ts',
    ],
    manual: ['Lay the controllers down and take them up again while drawing.'],
  },
  'space-reset': {
    inject: 'The reference space is reset: 90° and 1 m',
    sees: 'The world is re-anchored, the temporal window cleared; others see a jump and no streak',
    target: '0 poses between the two places',
    tests: [
      'tests/reliability/space-reset.test.ts',
      'tests/rooms/client/remote-players.test.ts',
      'tests/threepoint/xr/tracked-session.test.ts',
    ],
    manual: ['Hold the system button to recentre, turned by a quarter: the range lies ahead at once.'],
  },
  rates: {
    inject: '72, 80, 90 and 120 Hz, 30 % of the frames dropped',
    sees: 'The same arrows, balls and bodies',
    target: 'trajectories within 1 mm; throws of a hand within 10 cm/s',
    tests: ['tests/reliability/rates.test.ts'],
    manual: ['Change the headset’s rate in its settings: the score of the built-in archer stays 50.'],
  },
  people: {
    inject: 'Heights of 1.10 to 2.20 m, seated, crouching, a floor that is off by 0.5 m',
    sees: 'Two seconds of calibration, and the body fits; above a floor that is too low the page asks to type the height',
    target: 'wrists 0 mm off the hands within reach; the pelvis never below the floor',
    tests: ['tests/reliability/people.test.ts'],
    manual: ['Sit down, calibrate, and shoot a round; stand on a step and do the same.'],
  },
  flows: {
    inject: 'Left-handed, one-handed, seated, small, tall',
    sees: 'Every round of both games can be finished',
    target: '100 %',
    tests: ['tests/reliability/flows.test.ts'],
    manual: ['Play archery with one hand (Rules and hands) and hold the basket with one hand.'],
  },
  comfort: {
    inject: 'Turning by the stick, small text, no sound, colour-blind eyes, reduced motion',
    sees: 'Snap turns behind a vignette, text that grows, captions (in the headset where the sound is off), rings told apart by brightness, no movement of the page',
    target: 'a turn turns about the head: 0 mm; contrast 4.5 : 1',
    tests: [
      'e2e/page/desktop.spec.ts',
      'tests/reliability/comfort.test.ts',
      'tests/threepoint/xr/tracked-session.test.ts',
      'tests/page/archery/boards.test.ts',
      'tests/page/archery/archery-captions.test.ts',
      'tests/study/model/trial-log.test.ts',
    ],
    manual: ['Push a stick to the side: one step of 30°, dark edges for a moment, no nausea.'],
  },
  'no-headset': {
    inject: 'No WebXR, no HTTPS, a session refused',
    sees: 'A sentence that says why, and the desktop mode',
    target: 'within 1 s',
    tests: ['tests/threepoint/xr/session.test.ts', 'e2e/page/faults.spec.ts'],
  },
  'graphics-lost': {
    inject: 'The WebGL context is lost and restored, in the mirror, in archery and in the ball game',
    sees: 'Everything is uploaded again; the game goes on where it was',
    target: 'a picture within 3 s',
    tests: ['e2e/page/faults.spec.ts'],
    manual: [
      'In a session a headset’s own layer is lost too: the page leaves VR with a sentence; enter again, the score is still there.',
    ],
  },
  'no-wasm': {
    inject: 'WASM missing, blocked by the policy, not compiling; its worker missing or dead',
    sees: 'IK takes over, a notice says so',
    target: 'the avatar moves within 2 s',
    tests: ['e2e/threepoint/models.spec.ts'],
  },
  'bad-model': {
    inject: 'A model missing, truncated, of the wrong hash or shape, or answering NaN',
    sees: 'IK takes over, the page says so',
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
    inject: 'Page time steps back or ahead by 5 or 20 s, and back again',
    sees: 'Rules, bodies, built-in players, playback of others, recordings and the log of a trial go on at once',
    target: 'no standstill; on by half a second at most; every frame once, in order',
    tests: [
      'tests/reliability/clock-steps.test.ts',
      'tests/threepoint/core/tracking/page-clock.test.ts',
      'tests/rooms/client/clock-sync.test.ts',
    ],
  },
  'avatar-missing': {
    inject: 'The address of an avatar answers 404, a web page, 61 MB, a compressed body, a body without bones',
    sees: 'Our own body stands there until another has arrived, and stays; a sentence says why; the panel offers *Back to the page’s avatar*',
    target: 'our own body with the first picture, 5 of 5',
    tests: ['e2e/page/avatar-address.spec.ts', 'tests/ui/limited-files.test.ts'],
  },
  'bad-input': {
    inject:
      'A recording of 300 MB, an event of a button without its frame, switches that mean nothing, a storage that is denied',
    sees: 'A sentence in words, once; nothing is read, thrown or lost',
    target: '0 bytes read, 0 exceptions',
    tests: [
      'tests/ui/limited-files.test.ts',
      'tests/threepoint/xr/frameless-events.test.ts',
      'tests/page/shell/switches.test.ts',
      'tests/page/shell/preferences.test.ts',
    ],
  },
  'long-run': {
    inject: 'Twenty minutes of archery rounds by the actor (nightly)',
    sees: 'Nothing grows after the first round',
    target: 'textures, geometries, programs, listeners, workers +0; objects on the heap +10 % at most',
    tests: ['e2e/page/long-run.spec.ts', 'tests/reliability/long-run.test.ts'],
    manual: ['The same in the headset, its memory read with the browser’s remote inspector.'],
  },
} as const satisfies Readonly<Record<string, Row>>;

/** Promises 4 to 8, about the page, names, avatars and stored data. */
export const promiseRows = {
  policy: {
    inject:
      'Promise 4: scripts of other origins, inline scripts, `eval`, `new Function`; a file named by the address of a server that is not listed',
    sees: 'Nothing of it runs and nothing is asked for; every asset is our own',
    target: '0 run; 0 requests elsewhere',
    tests: ['tests/server/page.test.ts', 'e2e/page/faults.spec.ts', 'e2e/page/avatar-address.spec.ts'],
  },
  isolation: {
    inject: 'Promise 5: Permissions-Policy; the page with and without cross-origin isolation',
    sees: 'WebXR for the page alone; the same page either way',
    target: 'both load, same estimator and provider',
    tests: ['tests/server/page.test.ts', 'e2e/page/faults.spec.ts'],
  },
  text: {
    inject: 'Promise 6: names, captions and comments that are markup, control characters or formulas',
    sees: 'Text, and nothing else',
    target: '0 elements made; 0 formulas in a CSV',
    tests: [
      'tests/reliability/text.test.ts',
      'e2e/rooms/foreign-text.spec.ts',
      'tests/rooms/protocol/messages.test.ts',
      'tests/study/model/tidy-csv.test.ts',
    ],
  },
  avatars: {
    inject:
      'Promise 7: avatar files too large, with too many triangles, textures or bones, with URIs, invalid, made to exhaust',
    sees: 'A sentence that says which limit; our own body stays',
    target: '100 % refused; 0 requests; ours and VRM 0.x accepted',
    tests: ['tests/threepoint/avatar/inspect-avatar.test.ts', 'e2e/page/avatar.spec.ts'],
  },
  privacy: {
    inject: 'Promise 8: a game and a study played, then the server’s files and memory read',
    sees: 'No motion kept without consent; none older than 2 s in a room',
    target: '0 bytes of motion on disk; 0 poses older than 2 s',
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
    inject:
      '100,000 request lines, methods, headers and bodies by a grammar, over raw sockets, to every route (1,000 by day)',
    sees: 'Each gets an answer with our headers; the process lives, health answers meanwhile',
    target: '0 without an answer, 0 faults, health within 50 ms',
    tests: ['tests/server/any-request.test.ts'],
  },
  'any-packet': {
    inject:
      '100,000 WebSocket frames by a grammar (2,000 by day), from strangers, listeners of the lobby, guests and seated players',
    sees: 'What is no packet ends its own connection; the process lives, others are answered',
    target: '0 processes ended; another player is answered after each batch',
    tests: ['tests/rooms/server/any-packet.test.ts', 'tests/rooms/protocol/messages.test.ts'],
  },
  'hostile-player': {
    inject:
      'A seated player who is everywhere at once (false times, a new anchor in every packet), and who changes body, voice, measures and seat with every message',
    sees: 'Others see a head that goes no faster than heads do, and a few changes of a seat; the last one is what they end with',
    target: '20 m/s, and one leap a second; half a change a second of each seat, after eight',
    tests: ['tests/rooms/room/hostile-player.test.ts'],
  },
  'mutated-poses': {
    inject:
      '1,000,000 valid pose packets with bits, bytes and lengths changed (50,000 by day), from the three seats of a room',
    sees: 'Each reaches the others whole or not at all; every body is made of finite numbers, for the least and greatest measures',
    target: '0 exceptions, 0 frames that no page can read, 0 joints that are no number',
    tests: [
      'tests/rooms/room/mutated-poses.test.ts',
      'tests/rooms/room/room-faults.test.ts',
      'tests/rooms/protocol/pose-codec.test.ts',
    ],
  },
  'mutated-avatars': {
    inject:
      '100,000 files of avatars with bits, lengths and values of their description changed (3,000 by day), and as many FBX files (10,000 by day)',
    sees: 'A sentence that names the file, from the check or from the reader, or a body of finite numbers',
    target: '0 exceptions without a sentence, 0 numbers that are none, no FBX file that takes a second',
    tests: [
      'tests/threepoint/avatar/mutated-files.test.ts',
      'tests/threepoint/avatar/mutated-fbx.test.ts',
      'tests/threepoint/avatar/inspect-avatar.test.ts',
    ],
  },
  'mutated-motion': {
    inject: '100,000 BVH files and VRM Animations with lines, words, bytes and values changed (10,000 by day)',
    sees: 'A sentence that names the file, or trackers of finite numbers, with a second of work at most',
    target: '0 exceptions without a sentence, 0 numbers that are none, 1 s of work on one file at most',
    tests: ['tests/threepoint/core/mocap/mutated-motion.test.ts'],
  },
  crowd: {
    inject:
      'Two hundred rooms of three play the ball game for ten minutes (20 rooms for 5 s by day); then all players are gone at once, and two more such crowds come and go',
    sees: 'Rooms are stepped on time, poses arrive, and nothing is kept of them once the held seats have run out',
    target:
      'event loop p99 20 ms where the machine is idle; memory held within 5 % of before, the process within 5 % from crowd to crowd',
    tests: ['tests/rooms/server/crowded-rooms.test.ts'],
  },
  'voice-signals': {
    inject:
      'A seated player signals a video, a channel of data, a second voice, control bytes or an address that belongs to no part to the page of another',
    sees: 'Neither room nor page takes it: no browser is given more than one voice, and none fails at it',
    target: '0 passed on; messages to the voices of another room 0',
    tests: ['tests/rooms/protocol/messages.test.ts', 'tests/rooms/server/voices.test.ts'],
  },
  'unwanted-bodies': {
    inject: 'A body of 200 MB, announced or in chunks, for a page or a route that takes none or little',
    sees: 'The refusal is heard, and the connection ends instead of reading on',
    target: 'no more than the buffers of the system and 1 MiB',
    tests: ['tests/http/connection-limiter.test.ts'],
  },
  connections: {
    inject: '1,500 silent TCP connections and WebSockets from one address, its limit 1,000',
    sees: 'All are counted in health and metrics; those beyond the limit are ended at once, the others at the deadline of 5 s',
    target: '0 open after the deadline; health of other addresses at most 5 ms later (p95)',
    tests: ['tests/http/connection-limiter.test.ts'],
  },
  'client-addresses': {
    inject:
      'Joins, WebSockets and guesses of one client under ever new addresses: a whole /64, ports, brackets, mapped and other spellings behind a proxy',
    sees: 'Every limit counts them as one client; a forwarded value that is no address, two Host lines and a target of another authority get 400',
    target: '5 of 40 joins, 256 of 300 WebSockets, at most 7 of 40 wrong tokens checked',
    tests: ['tests/http/client-address.test.ts'],
  },
  'avatar-store': {
    inject:
      'The store of avatars: filled by seats in several rooms, by uploads without an end, with what is no avatar or another one than its name says',
    sees: 'A sentence; what others have stored stays, and they find place for theirs; all goes with its owner’s seat',
    target: 'a quarter of the store for an address; nothing beyond its bound, nothing stored that was refused',
    tests: ['tests/rooms/server/avatars.test.ts', 'e2e/rooms/seen-avatars.spec.ts'],
  },
  'full-disk': {
    inject: 'The disk of the studies is full',
    sees: '507 and a sentence; what was acknowledged stays; writing goes on once there is room',
    target: '0 acknowledged and lost',
    tests: ['tests/study/server/study-routes.test.ts'],
  },
  'study-lock': {
    inject: 'Another program holds the lock of the studies’ database for 30 s (8 s by day)',
    sees: 'Rooms go on; reads are answered, writes are refused with 503 and a time to try again',
    target: 'delay of the event loop 20 ms at most (p99); 0 answered 408; 0 acknowledged and lost',
    tests: ['tests/study/server/hung-database.test.ts'],
  },
  'study-disk': {
    inject: 'The disk of the studies does not finish a flush for 30 s (12 s by day)',
    sees: 'Rooms go on; reads are answered, no write is acknowledged: 503 and a time to try again',
    target: 'delay of the event loop 20 ms at most (p99); 0 answered 408; 0 acknowledged and lost',
    tests: ['tests/study/server/hung-database.test.ts'],
  },
  'study-folder': {
    inject:
      'The folder of the studies: open to other accounts, deleted or replaced under the server, of another server, with a database that is damaged, locked, newer or foreign',
    sees: 'Closed to others at the start; 507 and a line of the log until it is back; a start that is refused with the file and what to do',
    target: '0 files open to others; 0 acknowledged and lost; a sentence for every start that is refused',
    tests: ['tests/study/server/study-folder.test.ts'],
  },
  'study-replays': {
    inject:
      'What a participant’s page sends, out of order, twice and after consent to motion was taken back; a link that twenty people open at once',
    sees: 'Each record is stored once; the latest report and the last word on consent hold; one person has the place',
    target: '0 records lost or stored twice, 0 reports that lead back, 1 place',
    tests: ['tests/study/server/study-replays.test.ts'],
  },
  'study-back': {
    inject:
      'A participant presses the browser’s back button and then forward, at every kind of step of a study and in a round',
    sees: 'The study is where it was, with every answer; a round that was left is void and tried again',
    target: '0 records lost or stored twice',
    tests: ['e2e/study/study-back.spec.ts'],
  },
  'study-traces': {
    inject:
      'Two of three participants withdraw or are deleted after a whole session with motion, exports and a log of every detail; every file is searched',
    sees: 'No text, secret, address or motion of theirs in database, write-ahead log, log, temporary files or exports',
    target: '0 traces',
    tests: ['tests/study/server/study-traces.test.ts'],
  },
  'storage-denied': {
    inject: 'A browser that lets no site store anything: the page, a room and a study in it',
    sees: 'All three work, and the page says that this browser keeps nothing',
    target: '0 pages that fail',
    tests: ['e2e/page/storage-denied.spec.ts'],
  },
  'storage-blocked': {
    inject:
      'IndexedDB alone is blocked: missing, null, throwing, of a newer version, without an answer, or failing under way, in a study and on the page',
    sees: 'The study goes on, the experimenter’s commands arrive, answers reach the server; the page says that nothing is stored',
    target: '0 sessions that stand still; 0 records lost',
    tests: ['tests/study/participant/blocked-storage.test.ts', 'e2e/page/storage-denied.spec.ts'],
  },
  'first-folder': {
    inject:
      'The folder of studies that the first version of the program left, with a study whose plan is not allowed any more',
    sees: 'Everything is there, its pages go on; the study that is not allowed is listed, exported and deleted, and no one else joins it',
    target: '0 records lost, 0 studies that cannot be read',
    tests: ['tests/study/server/study-migrations.test.ts'],
  },
  'study-shortage': {
    inject:
      'A heap of 64 MB, a limit of open files that strangers use up, a disk that is full, while a study is exported',
    sees: 'A sentence that says what is short and what to do; the server goes on',
    target: '0 faults, 0 acknowledged and lost',
    tests: ['tests/study/server/study-shortage.test.ts'],
  },
  'server-clock': {
    inject: 'The clock of the server goes an hour ahead and an hour back, in a game and in a study',
    sees: 'Rooms go on; passes are renewed; records keep their order and none is refused',
    target: '0 players gone, 0 records refused',
    tests: ['tests/rooms/server/server-clock.test.ts'],
  },
  'hidden-tab': {
    inject: 'The tab of a player is behind another one for 12 s, 1 min and 5½ min, with its timers throttled',
    sees: 'Others see “away”; the bots of the page leave their seats to bots of others; all is right with the first frames of the return',
    target: '0 seats lost, 0 errors, the heap at most 4 MB larger',
    tests: ['e2e/page/hidden-tab.spec.ts'],
  },
  asleep: {
    inject:
      'The system of a player or participant sleeps in a match or a study, and its clocks have gone on by an hour: both, or that of the day alone',
    sees: 'The page is back in its seat and the match goes on, as a void round where the room is gone; the study goes on where it was',
    target: '0 seats lost; 0 records refused',
    tests: ['e2e/page/asleep.spec.ts', 'tests/study/participant/asleep.test.ts'],
  },
  'study-places': {
    inject:
      'Places of a study claimed without an invitation: by another site’s page, by a loop over all of them, by guesses',
    sees: 'A sentence; the places stay free for those who were invited',
    target: '0 places taken',
    tests: ['tests/study/server/study-entry.test.ts', 'tests/study/server/study-places.test.ts'],
  },
  'other-sites': {
    inject:
      'Requests of pages of other sites: foreign origins, https origins at the http port, names pointed at this machine',
    sees: 'Every one of them that would change something, or read what is not public, is refused',
    target: '0 answered',
    tests: ['tests/http/site-policy.test.ts', 'tests/study/server/study-entry.test.ts', 'tests/server/access.test.ts'],
  },
  'study-rooms': {
    inject: 'A stranger looks for the room of a study’s trial, asks for a pass to it, forges one',
    sees: 'It is in no list; its seats are signed for its participants; only an experimenter may watch',
    target: '0 lists, 0 seats',
    tests: ['tests/study/server/study-rooms.test.ts'],
  },
  guessing: {
    inject:
      '3000 guesses of the experimenter’s token, of withdrawal codes and of invitations, one after the other and all at once',
    sees: 'Five are looked at, then one after 1, 2, 4 … seconds; the log has who guessed and never what',
    target: '10 of 3000 looked at, at most',
    tests: ['tests/study/server/study-entry.test.ts', 'tests/http/auth-throttle.test.ts'],
  },
  access: {
    inject:
      'Every route and socket event as a stranger, a participant, another participant, an experimenter and another site',
    sees: 'What docs/security.md says for each',
    target: 'no route or event without a row; no cell that differs',
    tests: ['tests/server/access.test.ts'],
  },
} as const satisfies Readonly<Record<string, Row>>;

export type RowName = keyof typeof faultRows | keyof typeof promiseRows | keyof typeof attackRows;

export const rows: Readonly<Record<RowName, Row>> = { ...faultRows, ...promiseRows, ...attackRows };
