import { calibrationFaults } from 'threepoint/core';
import { gamePhrases } from './game-phrases';

/**
 * The phrases of the page for participants, by key. Names in braces are filled in. A phrase with a number has the
 * plural forms of its language, chosen by {count}.
 */
export const english = {
  // Buttons of several screens.
  next: 'Next',
  back: 'Back',
  pause: 'Pause',
  continue: 'Continue',
  submit: 'Submit',
  start: 'Start',
  loading: 'Loading …',
  stop: 'Stop',
  stopStudy: 'Stop the study',
  enterVr: 'Enter VR',
  measureAgain: 'Measure again',
  tryAgain: 'Try again',

  // Texts of several screens.
  study: 'Study',
  progress: 'Progress',
  language: 'Language',
  round: 'Round {number}',
  practice: 'Practice',
  simulated: 'SIMULATED',
  metres: '{length} m',
  callExperimenter: 'Please call the experimenter',
  askExperimenter: 'Ask the experimenter.',

  // Entrance and consent.
  'entrance.title': 'Who takes part?',
  'entrance.code': 'Your code: a P and two or three digits',
  'entrance.invitation': 'Your invitation: sixteen letters and digits',
  'entrance.wrongCode': 'Your code is a P with two or three digits, such as P01.',
  'entrance.noInvitation': 'The place needs an invitation. Enter it, or open your link.',
  'entrance.wrongInvitation':
    'This is not the invitation of {participant}. Compare it with your link, or ask the experimenter.',
  'entrance.wrongInvitationRemote': 'This is not the invitation of {participant}. Compare it with your link. {contact}',
  'entrance.taken': '{participant} is taken by another device: go on there, or ask for the place to be released.',
  'entrance.otherTab': '{participant} is open in another tab of this browser. Go on there, or close it.',
  'entrance.noStudy': 'There is no study "{study}" on this server. Compare the address with your link.',
  'entrance.fault': 'The study cannot continue here',
  'consent.kicker': 'Consent · text of {version}',
  'consent.simulated': 'This study is SIMULATED: its records are marked as made by a program.',
  'consent.understood': 'I have read this, I am old enough to decide for myself, and I want to take part.',
  'consent.nothingRecorded': 'Nothing is recorded before you agree.',
  'consent.agree': 'I agree',
  'consent.decline': 'I do not want to take part',
  'declined.title': 'Thank you anyway',
  'declined.text': 'Nothing was recorded. You can close this page, or open your link again.',

  // The withdrawal code.
  'code.kicker': 'Your withdrawal code',
  'code.title': 'Please write this down',
  'code.use': 'With this code you can have all your data deleted, at any time and without giving a reason:',
  'code.once': 'It is shown only now and cannot be looked up later: note it, also if you stop here.',
  'code.noted': 'I have noted it',
  'code.save': 'Save both as a file',
  'code.file': 'Withdrawal code: {code}\nTo have everything deleted, enter it at {address}',

  // Questions about participants.
  'about.kicker': 'About you',
  'about.title': 'Before you play',
  'about.missing': 'The marked questions still need an answer.',
  'about.ageRange': 'Your age: a whole number from {from} to {to}.',
  'about.gender': 'Gender',
  'about.gender.woman': 'Woman',
  'about.gender.man': 'Man',
  'about.gender.non-binary': 'Non-binary',
  'about.gender.other': 'Another',
  'about.gender.not-said': 'I prefer not to say',
  'about.age': 'Age [years]',
  'about.major': 'Field of study or work',
  'about.vrExperience': 'How often have you used virtual reality?',
  'about.vrExperience.none': 'Never',
  'about.vrExperience.once-or-twice': 'Once or twice',
  'about.vrExperience.several-times': 'Several times',
  'about.vrExperience.monthly': 'Every month',
  'about.vrExperience.weekly': 'Every week',
  'about.vrSystems': 'Which systems? (may stay empty)',
  'about.handedness': 'Which hand do you prefer?',
  'about.handedness.right': 'Right',
  'about.handedness.left': 'Left',
  'about.handedness.both': 'Both alike',
  'about.vision': 'How do you see?',
  'about.vision.normal': 'Well without correction',
  'about.vision.corrected': 'Well with glasses or lenses',
  'about.vision.impaired': 'Impaired, also in the headset',

  // Putting the headset on, and faults of the set-up of participants who take part alone.
  'headset.title': 'Put on the headset',
  'headset.measures':
    'Press the button, put the headset on and take both controllers. You are measured first: it takes five seconds.',
  'headset.round': 'The next part is played in the headset.',
  'setup.title': 'Not quite ready',
  'setup.device': 'This device cannot be used',
  'setup.contact': 'If this does not help: {contact}',
  'setup.insecure': 'VR needs a secure page: its address has to begin with https://.',
  'setup.noWebxr': 'This browser has no WebXR.',
  'setup.noHeadset': 'No headset is connected to this browser.',
  'setup.refused': 'WebXR is not allowed here ({reason}).',
  'setup.openThere': '{fault} Open this link in the browser of your headset.',
  'setup.room':
    'Your boundary leaves {width} by {depth}, the games need {needed} on either side. Clear more room and draw the boundary again.',
  'setup.low':
    'Your eyes were measured {height} above the floor. Stand up. If you are standing, the floor of the headset is too high: set it again in its settings.',
  'setup.high':
    'Your eyes were measured {height} above the floor: the floor of the headset is too low. Set it again in its settings.',

  // Measurement of the body.
  'measures.title': 'Your measures',
  'measures.stance':
    'Stand straight inside the marked zone, look ahead and stretch both arms forward, wrists straight, when the countdown begins.',
  'measures.press': 'Point at the button and pull the trigger, or touch it.',
  'measures.begin': 'Measure me',
  'measuring.title': 'Stand still',
  'measuring.instruction': 'Stand straight, look ahead, stretch both arms forward, wrists straight.',
  'measuring.hold': 'Hold still',
  'measuring.done': 'Done',
  'measuring.failed': 'Once more, please',
  'measuring.lost': calibrationFaults.lost,
  'measuring.headMoved': calibrationFaults.headMoved,
  'measuring.gaze': calibrationFaults.gaze,
  'measuring.leftUnseen': calibrationFaults.leftUnseen,
  'measuring.rightUnseen': calibrationFaults.rightUnseen,
  'measuring.handsMoved': calibrationFaults.handsMoved,
  'measuring.handsUnseen': calibrationFaults.handsUnseen,
  // Participants of a study all take one pose: the others are not offered.
  'measuring.elsewhere':
    'Your arms pointed somewhere else. Stretch them straight forward, at the height of your shoulders.',
  'measuring.bent':
    'Your arms were not stretched. Stretch them straight forward. If they were stretched, the floor of the headset is too low: set it again in its settings.',
  'measuring.tooLong': calibrationFaults.tooLong,
  'measuring.uneven': calibrationFaults.uneven,
  'measuring.unlikely':
    'These measures cannot be right. Stand up straight. The floor of the headset may be at the wrong height.',

  // Rounds.
  'ready.title': 'Ready?',
  'ready.awaited': 'Your group is waiting for you in a match that has begun. Press Start. Time left: {time}',
  'ready.again': 'The last attempt was interrupted and does not count.',
  ...gamePhrases('en', 'ready'),
  'ready.practice': {
    one: 'Try it for {count} second. This does not count.',
    other: 'Try it for {count} seconds. This does not count.',
  },
  'ready.seconds': {
    one: 'You have {count} second from the start. Stay inside the marked zone.',
    other: 'You have {count} seconds from the start. Stay inside the marked zone.',
  },
  'ready.raise': 'To pause or to stop, hold both hands above your head.',
  voided: 'The experimenter has set the last part aside. It does not count.',
  'round.failed': 'This round cannot start',
  'round.body': 'The body of this round could not be loaded.',
  ...gamePhrases('en', 'round'),
  'round.game': 'This page cannot play the game of this task.',
  'waiting.title': 'You are ready',
  'waiting.for': {
    one: 'It begins as soon as {names} is ready too.',
    other: 'It begins as soon as {names} are ready too.',
  },
  'waiting.others': 'It begins as soon as the others are ready too.',
  'standing.text': 'One of your group has paused. The game will continue where it stopped.',
  'standing.away': 'The match waits for {names}. It will continue where it stopped.',
  'standing.limit': 'It is given up when this time is over:',
  'rest.title': 'A rest',
  'rest.text': 'Relax your arms. The study continues by itself.',

  // Questions.
  'question.all': 'Questions',
  'question.of': '{number} of {total}',
  'question.needed': 'An answer is needed',
  'question.neededNote': '* An answer is needed.',
  'question.mayStayOpen': '(optional)',
  'question.answered': 'Question {number}, answered',
  'question.open': 'Question {number}, needs an answer',
  'question.optional': 'Question {number}, optional',
  'question.range': 'From {low} to {high}',
  'question.field': 'Answer',
  'question.thisOpen': '* This question still needs an answer.',
  'question.someOpen': {
    one: '* {count} of {total} still needs an answer.',
    other: '* {count} of {total} still need an answer.',
  },
  'question.wholeNumber': '* Expected a whole number from {from} to {to}.',
  'question.number': '* Expected a number from {from} to {to}.',
  'question.text': {
    one: '* Expected text of at most {count} character.',
    other: '* Expected text of at most {count} characters.',
  },
  'question.timeLeft': '{time} left',
  'question.takeTime': 'Take the time you need.',
  /** Rows of letters of the keyboard in the headset, separated by spaces; at most twelve in each of four. */
  'keys.rows': "1234567890 qwertyuiop asdfghjkl' zxcvbnm,.-",
  'keys.space': 'Space',
  'keys.delete': 'Delete',

  // Pausing and stopping.
  'paused.title': 'Paused',
  'paused.text': 'Everything is stopped. Take the headset off if you like.',
  'stopping.title': 'Stop here?',
  'stopping.text': 'If you stop, your part is over. You need not give a reason. Your data so far are kept.',
  'stopping.goOn': 'Go on',
  'unwell.title': 'How are you?',
  'unwell.text': 'Your answers suggest that you may not feel well. Take the headset off if you like.',
  'unwell.contact': 'If it does not pass: {contact}',
  'unwell.goOn': 'I am well: go on',
  'refused.paused': 'The session is paused.',
  'refused.asked': 'First say whether you want to stop.',
  /** A technical reason, which is in English in every language. */
  reason: '{reason}',

  // Upload status.
  'kept.all': 'Everything is saved.',
  'kept.saving': 'Saving …',
  'kept.sending': 'Sending …',
  'kept.offline': {
    one: 'No connection: {count} record is kept on this device and sent later.',
    other: 'No connection: {count} records are kept on this device and sent later.',
  },
  'kept.noRoom': {
    one: 'Keep this page open: {count} record cannot be stored on this device ({reason}).',
    other: 'Keep this page open: {count} records cannot be stored on this device ({reason}).',
  },
  'kept.noStorage': 'this browser offers no storage',
  'kept.silentStorage': 'the storage of this browser does not answer',
  'kept.refused': {
    one: 'Call the experimenter: the server refuses {count} record ({reason}). It stays here.',
    other: 'Call the experimenter: the server refuses {count} records ({reason}). They stay here.',
  },
  'kept.refusedRemote': {
    one: 'It stays on this device: the server refuses {count} record ({reason}). You can go on. {contact}',
    other: 'They stay on this device: the server refuses {count} records ({reason}). You can go on. {contact}',
  },

  // The end, and a place that belongs to another device.
  'end.title': 'Thank you',
  'end.stopped': 'Your part is over. Take the headset off and rest.',
  'end.done': 'You have done everything.',
  'end.arrived': 'All your answers have arrived. You can close this page.',
  'end.keepOpen': 'Please keep this page open until your answers have arrived.',
  'end.withdraw': 'With your withdrawal code you can have everything deleted: {address}',
  'lockedOut.title': 'The study continues elsewhere',
  'lockedOut.released': 'Your place was released for another device. Take the headset off, please.',
  'lockedOut.deleted': 'Your place was released for another device, or deleted. Take the headset off, please.',
  'lockedOut.silent': 'This device no longer sends data.',
  'lockedOut.place':
    '{participant} was released for another device, or its data were deleted. This device no longer sends data.',
  'lockedOut.contact': 'If you have not withdrawn or continued elsewhere: {contact}',
  'lockedOut.unsent': {
    one: '{count} record was never sent. Starting again deletes it from this device.',
    other: '{count} records were never sent. Starting again deletes them from this device.',
  },
  'lockedOut.restart': 'Delete it here and start again',

  // The withdrawal page.
  'withdrawal.title': 'Withdraw from a study',
  'withdrawal.study': 'The study, as it stands in your link',
  'withdrawal.code': 'Your withdrawal code',
  'withdrawal.explained':
    'All your data in this study are deleted at once: answers, results, movements and progress. Only a receipt stays, with the time and the number of deleted records. You need not give a reason. The deletion cannot be undone, and you cannot take part again.',
  'withdrawal.sure': 'I want all my data deleted.',
  'withdrawal.delete': 'Delete everything',
  'withdrawal.motionOnly': 'Delete only my movements',
  'withdrawal.lookUp': 'The code was shown to you after you agreed to take part; no one can look it up.',
  'withdrawal.contact': 'If something does not work: {contact}',
  'withdrawal.unknownCode':
    'Nothing is recorded under this code. Compare it with your note; if you have sent it before, everything is deleted already.',
  'withdrawal.unheard':
    'It is unknown whether your data were deleted: {reason}. Send the code again. If they were, the code is no longer known.',
  'withdrawal.failed': 'The deletion failed: {reason}.',
  'receipt.name': 'Receipt',
  'receipt.title': 'Everything is deleted',
  'receipt.motionTitle': 'Your recorded movements are deleted',
  'receipt.motionKept':
    'No more movements are recorded. Your answers and results stay; the same code deletes them too.',
  'receipt.number': 'Receipt {number} of the study “{study}”',
  'receipt.deleted': 'Deleted of {participant}: {records}, {recordings}',
  'receipt.records': { one: '{count} record', other: '{count} records' },
  'receipt.recordings': { one: '{count} recording of movements', other: '{count} recordings of movements' },
  'receipt.when': '{time}, by the withdrawal code, at {address}',
  'receipt.hereToo':
    'The data in this browser are deleted too. If you used another device, open your link there to delete the rest.',
  'receipt.elsewhere': 'If you took part on another device, open your link there to delete the rest.',
  'receipt.copies':
    'Copies that were passed on before are not on this server. With the number of this receipt you can have them deleted too.',
  'receipt.save': 'Save the receipt',
} as const;

export type PhraseKey = keyof typeof english;

/** The forms of a phrase with a number, by the names of Unicode's plural rules. */
export interface PluralForms {
  readonly zero?: string;
  readonly one?: string;
  readonly two?: string;
  readonly few?: string;
  readonly many?: string;
  readonly other: string;
}
export type Phrase = string | PluralForms;
/** The page's phrases in one language. */
export type Catalogue = Readonly<Record<PhraseKey, Phrase>>;
/** Phrases of a plan, which may leave out keys. */
export type GivenPhrases = Readonly<Record<string, Phrase | undefined>>;
