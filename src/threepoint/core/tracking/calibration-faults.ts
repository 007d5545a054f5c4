/** The messages of a failed guided calibration, by fault: the reason, and what to do. */
export const calibrationFaults = {
  lost: 'Tracking was lost. Try again where the headset sees the room.',
  headMoved: 'Your head moved. Stand still for two seconds.',
  gaze: 'You looked up or down. Look straight ahead.',
  leftUnseen: 'Your left hand was not seen all the time. Hold it where you can see it.',
  rightUnseen: 'Your right hand was not seen all the time. Hold it where you can see it.',
  handsMoved: 'Your hands moved. Hold them still for two seconds.',
  handsUnseen: 'Your hands were not seen. Hold them where you can see them.',
  elsewhere:
    'Your arms pointed somewhere else. Stretch them straight forward at shoulder height, or down and out by 45°.',
  bent: 'Your arms were not stretched. Stretch them straight forward; if they were, the floor is too low: type your height instead.',
  tooLong: 'Your arms are too long for the height of your head. Stand up straight, and check the floor’s height.',
  uneven: 'One arm was stretched further than the other. Stretch both straight forward.',
  unlikely: 'The headset’s floor may be at the wrong height: type your height instead.',
} as const;

export type CalibrationFault = keyof typeof calibrationFaults;
