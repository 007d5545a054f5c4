import type { Catalogue } from './english';
import { gamePhrases } from './game-phrases';

/** The German phrases of the page. */
export const german = {
  next: 'Weiter',
  back: 'Zurück',
  pause: 'Pause',
  continue: 'Weiter',
  submit: 'Abgeben',
  start: 'Start',
  loading: 'Wird geladen …',
  stop: 'Abbrechen',
  stopStudy: 'Teilnahme abbrechen',
  enterVr: 'VR starten',
  measureAgain: 'Erneut messen',
  tryAgain: 'Erneut versuchen',

  study: 'Studie',
  progress: 'Fortschritt',
  language: 'Sprache',
  round: 'Runde {number}',
  practice: 'Übung',
  simulated: 'SIMULIERT',
  metres: '{length} m',
  callExperimenter: 'Bitte rufen Sie die Versuchsleitung',
  askExperimenter: 'Bitte wenden Sie sich an die Versuchsleitung.',

  'entrance.title': 'Wer nimmt teil?',
  'entrance.code': 'Ihr Kürzel: ein P und zwei oder drei Ziffern',
  'entrance.invitation': 'Ihre Einladung: sechzehn Buchstaben und Ziffern',
  'entrance.wrongCode': 'Ihr Kürzel ist ein P mit zwei oder drei Ziffern, zum Beispiel P01.',
  'entrance.noInvitation': 'Ohne die Einladung ist keine Teilnahme möglich.',
  'entrance.wrongInvitation':
    'Das ist nicht die Einladung von {participant}. Bitte vergleichen Sie sie mit Ihrem Link oder fragen Sie die Versuchsleitung.',
  'entrance.wrongInvitationRemote':
    'Das ist nicht die Einladung von {participant}. Bitte vergleichen Sie sie mit Ihrem Link. {contact}',
  'entrance.taken':
    '{participant} nimmt bereits auf einem anderen Gerät teil: Machen Sie dort weiter, oder lassen Sie den Platz freigeben.',
  'entrance.otherTab':
    '{participant} ist in einem anderen Tab dieses Browsers geöffnet. Machen Sie dort weiter, oder schließen Sie ihn.',
  'entrance.noStudy':
    'Auf diesem Server gibt es keine Studie „{study}“. Bitte vergleichen Sie die Adresse mit Ihrem Link.',
  'entrance.fault': 'Die Studie kann hier nicht fortgesetzt werden',
  'consent.kicker': 'Einwilligung · Fassung {version}',
  'consent.simulated':
    'Diese Studie ist SIMULIERT: Was aufgezeichnet wird, ist als von einem Programm erzeugt gekennzeichnet.',
  'consent.understood':
    'Ich habe dies gelesen, bin alt genug, um selbst zu entscheiden, und möchte an der Studie teilnehmen.',
  'consent.nothingRecorded': 'Vor Ihrer Einwilligung wird nichts aufgezeichnet.',
  'consent.agree': 'Ich willige ein',
  'consent.decline': 'Ich möchte nicht teilnehmen',
  'declined.title': 'Trotzdem vielen Dank',
  'declined.text':
    'Es wurde nichts aufgezeichnet. Sie können diese Seite schließen oder Ihren Link noch einmal öffnen.',

  'code.kicker': 'Ihr Löschcode',
  'code.title': 'Bitte notieren Sie diesen Code',
  'code.use':
    'Mit diesem Code können Sie jederzeit und ohne Angabe von Gründen alles löschen lassen, was über Sie aufgezeichnet wurde:',
  'code.once':
    'Er wird nur jetzt angezeigt und kann später nicht nachgeschlagen werden. Notieren Sie ihn auch dann, wenn Sie hier abbrechen.',
  'code.noted': 'Ich habe ihn notiert',
  'code.save': 'Code und Adresse speichern',
  'code.file': 'Löschcode: {code}\nUm alles löschen zu lassen, geben Sie ihn hier ein: {address}',

  'about.kicker': 'Angaben zu Ihrer Person',
  'about.title': 'Bevor es losgeht',
  'about.missing': 'Bitte beantworten Sie noch, was markiert ist.',
  'about.ageRange': 'Bitte geben Sie Ihr Alter als ganze Zahl von {from} bis {to} an.',
  'about.gender': 'Geschlecht',
  'about.gender.woman': 'Weiblich',
  'about.gender.man': 'Männlich',
  'about.gender.non-binary': 'Nicht-binär',
  'about.gender.other': 'Ein anderes',
  'about.gender.not-said': 'Keine Angabe',
  'about.age': 'Alter [Jahre]',
  'about.major': 'Studienfach oder Beruf',
  'about.vrExperience': 'Wie oft haben Sie schon Virtual Reality genutzt?',
  'about.vrExperience.none': 'Noch nie',
  'about.vrExperience.once-or-twice': 'Ein- oder zweimal',
  'about.vrExperience.several-times': 'Mehrmals',
  'about.vrExperience.monthly': 'Jeden Monat',
  'about.vrExperience.weekly': 'Jede Woche',
  'about.vrSystems': 'Welche Systeme? (Angabe freiwillig)',
  'about.handedness': 'Welche Hand bevorzugen Sie?',
  'about.handedness.right': 'Die rechte',
  'about.handedness.left': 'Die linke',
  'about.handedness.both': 'Beide gleich',
  'about.vision': 'Wie sehen Sie?',
  'about.vision.normal': 'Gut ohne Sehhilfe',
  'about.vision.corrected': 'Gut mit Brille oder Kontaktlinsen',
  'about.vision.impaired': 'Eingeschränkt, auch im Headset',

  'headset.title': 'Setzen Sie das Headset auf',
  'headset.measures':
    'Drücken Sie den Knopf, setzen Sie das Headset auf und nehmen Sie beide Controller in die Hände. Zuerst werden Sie vermessen, das dauert fünf Sekunden.',
  'headset.round': 'Der nächste Teil wird im Headset gespielt.',
  'setup.title': 'Noch nicht ganz bereit',
  'setup.device': 'Dieses Gerät ist nicht geeignet',
  'setup.contact': 'Hilft das nicht? {contact}',
  'setup.insecure': 'VR setzt eine sichere Verbindung voraus: Die Adresse der Seite muss mit https:// beginnen.',
  'setup.noWebxr': 'Dieser Browser unterstützt kein WebXR.',
  'setup.noHeadset': 'An diesen Browser ist kein Headset angeschlossen.',
  'setup.refused': 'WebXR ist hier nicht erlaubt ({reason}).',
  'setup.openThere': '{fault} Öffnen Sie diesen Link im Browser Ihres Headsets.',
  'setup.room':
    'Ihr Spielbereich misst {width} mal {depth}, die Spiele brauchen auf jeder Seite {needed}. Schaffen Sie mehr Platz und zeichnen Sie den Spielbereich neu ein.',
  'setup.low':
    'Ihre Augen wurden {height} über dem Boden gemessen. Bitte stehen Sie auf. Falls Sie schon stehen, liegt der Boden des Headsets zu hoch: Richten Sie ihn in den Einstellungen neu ein.',
  'setup.high':
    'Ihre Augen wurden {height} über dem Boden gemessen: Der Boden des Headsets liegt zu tief. Richten Sie ihn in den Einstellungen neu ein.',

  'measures.title': 'Ihre Körpermaße',
  'measures.stance':
    'Stellen Sie sich aufrecht in den markierten Bereich. Sobald der Countdown beginnt, schauen Sie geradeaus und strecken beide Arme mit geraden Handgelenken nach vorn.',
  'measures.press': 'Zeigen Sie auf den Knopf und drücken Sie den Auslöser, oder berühren Sie ihn.',
  'measures.begin': 'Messung starten',
  'measuring.title': 'Bitte stillstehen',
  'measuring.instruction':
    'Stehen Sie aufrecht, schauen Sie geradeaus und strecken Sie beide Arme mit geraden Handgelenken nach vorn.',
  'measuring.hold': 'Stillhalten',
  'measuring.done': 'Fertig',
  'measuring.failed': 'Bitte noch einmal',
  'measuring.lost':
    'Die Positionsverfolgung ist ausgefallen. Versuchen Sie es dort noch einmal, wo das Headset den Raum sehen kann.',
  'measuring.headMoved': 'Ihr Kopf hat sich bewegt. Stehen Sie zwei Sekunden lang still.',
  'measuring.gaze': 'Sie haben nach oben oder unten geschaut. Schauen Sie geradeaus.',
  'measuring.leftUnseen':
    'Ihre linke Hand war nicht die ganze Zeit zu sehen. Halten Sie sie so, dass Sie sie sehen können.',
  'measuring.rightUnseen':
    'Ihre rechte Hand war nicht die ganze Zeit zu sehen. Halten Sie sie so, dass Sie sie sehen können.',
  'measuring.handsMoved': 'Ihre Hände haben sich bewegt. Halten Sie sie zwei Sekunden lang still.',
  'measuring.handsUnseen': 'Ihre Hände waren nicht zu sehen. Halten Sie sie so, dass Sie sie sehen können.',
  'measuring.elsewhere':
    'Ihre Arme haben in eine andere Richtung gezeigt. Strecken Sie sie auf Schulterhöhe gerade nach vorn.',
  'measuring.bent':
    'Ihre Arme waren nicht gestreckt. Strecken Sie sie gerade nach vorn. Falls sie gestreckt waren, liegt der Boden des Headsets zu tief: Richten Sie ihn in den Einstellungen neu ein.',
  'measuring.tooLong':
    'Ihre Arme sind zu lang für die Höhe Ihres Kopfes. Stehen Sie aufrecht, und prüfen Sie die Höhe des Bodens.',
  'measuring.uneven': 'Ein Arm war weiter gestreckt als der andere. Strecken Sie beide gerade nach vorn.',
  'measuring.unlikely':
    'Diese Maße können nicht stimmen. Stehen Sie aufrecht; vielleicht liegt der Boden des Headsets auf der falschen Höhe.',

  'ready.title': 'Bereit?',
  'ready.again': 'Der letzte Versuch wurde unterbrochen und zählt nicht.',
  ...gamePhrases('de', 'ready'),
  'ready.practice': {
    one: 'Probieren Sie es {count} Sekunde lang aus. Das zählt noch nicht.',
    other: 'Probieren Sie es {count} Sekunden lang aus. Das zählt noch nicht.',
  },
  'ready.seconds': {
    one: 'Ab dem Start haben Sie {count} Sekunde Zeit. Bleiben Sie im markierten Bereich.',
    other: 'Ab dem Start haben Sie {count} Sekunden Zeit. Bleiben Sie im markierten Bereich.',
  },
  'ready.raise': 'Um zu pausieren oder abzubrechen, halten Sie beide Hände über den Kopf.',
  'round.failed': 'Diese Runde kann nicht beginnen',
  'round.body': 'Der Körper für diese Runde konnte nicht geladen werden.',
  ...gamePhrases('de', 'round'),
  'round.game': 'Das Spiel dieser Aufgabe kann auf dieser Seite nicht gespielt werden.',
  'waiting.title': 'Sie sind bereit',
  'waiting.for': {
    one: 'Es geht los, sobald auch {names} bereit ist.',
    other: 'Es geht los, sobald auch {names} bereit sind.',
  },
  'waiting.others': 'Es geht los, sobald auch die anderen bereit sind.',
  'standing.text':
    'Jemand aus Ihrer Gruppe macht eine Pause. Danach geht das Spiel dort weiter, wo es angehalten wurde.',
  'rest.title': 'Zeit zum Ausruhen',
  'rest.text': 'Entspannen Sie Ihre Arme. Es geht von selbst weiter.',

  'question.all': 'Fragen',
  'question.of': '{number} von {total}',
  'question.needed': 'Eine Antwort ist erforderlich',
  'question.neededNote': '* Eine Antwort ist erforderlich.',
  'question.mayStayOpen': '(Antwort freiwillig)',
  'question.answered': 'Frage {number}, beantwortet',
  'question.open': 'Frage {number}, noch offen',
  'question.optional': 'Frage {number}, Antwort freiwillig',
  'question.range': 'Von {low} bis {high}',
  'question.field': 'Antwort',
  'question.thisOpen': '* Diese Frage ist noch nicht beantwortet.',
  'question.someOpen': {
    one: '* {count} von {total} Fragen ist noch offen.',
    other: '* {count} von {total} Fragen sind noch offen.',
  },
  'question.wholeNumber': '* Bitte geben Sie eine ganze Zahl von {from} bis {to} ein.',
  'question.number': '* Bitte geben Sie eine Zahl von {from} bis {to} ein.',
  'question.text': {
    one: '* Bitte geben Sie höchstens {count} Zeichen ein.',
    other: '* Bitte geben Sie höchstens {count} Zeichen ein.',
  },
  'question.timeLeft': 'Noch {time}',
  'question.takeTime': 'Nehmen Sie sich die Zeit, die Sie brauchen.',
  'keys.rows': '1234567890ß qwertzuiopü asdfghjklöä yxcvbnm,.-',
  'keys.space': 'Leertaste',
  'keys.delete': 'Löschen',

  'paused.title': 'Pause',
  'paused.text': 'Alles ist angehalten. Sie können das Headset abnehmen, wenn Sie möchten.',
  'stopping.title': 'Möchten Sie abbrechen?',
  'stopping.text':
    'Wenn Sie abbrechen, ist Ihre Teilnahme beendet. Sie müssen keinen Grund angeben, und was Sie bisher getan haben, bleibt gespeichert.',
  'stopping.goOn': 'Weitermachen',
  'unwell.title': 'Wie geht es Ihnen?',
  'unwell.text':
    'Ihre Antworten deuten darauf hin, dass es Ihnen nicht gut geht. Sie können das Headset abnehmen, wenn Sie möchten.',
  'unwell.contact': 'Falls es nicht besser wird: {contact}',
  'unwell.goOn': 'Mir geht es gut: weitermachen',
  'refused.paused': 'Gerade ist Pause.',
  'refused.asked': 'Bitte sagen Sie zuerst, ob Sie abbrechen möchten.',
  reason: 'Technischer Grund (englisch): {reason}',

  'kept.all': 'Alles ist gespeichert.',
  'kept.saving': 'Wird gespeichert …',
  'kept.sending': 'Wird gesendet …',
  'kept.offline': {
    one: 'Keine Verbindung: {count} Eintrag bleibt auf diesem Gerät und wird später gesendet.',
    other: 'Keine Verbindung: {count} Einträge bleiben auf diesem Gerät und werden später gesendet.',
  },
  'kept.noRoom': {
    one: 'Lassen Sie diese Seite geöffnet: {count} Eintrag kann auf diesem Gerät nicht gespeichert werden ({reason}).',
    other:
      'Lassen Sie diese Seite geöffnet: {count} Einträge können auf diesem Gerät nicht gespeichert werden ({reason}).',
  },
  'kept.noStorage': 'dieser Browser hat keinen Speicher',
  'kept.silentStorage': 'der Speicher dieses Browsers antwortet nicht',
  'kept.refused': {
    one: 'Bitte rufen Sie die Versuchsleitung: Der Server lehnt {count} Eintrag ab ({reason}). Er bleibt hier.',
    other: 'Bitte rufen Sie die Versuchsleitung: Der Server lehnt {count} Einträge ab ({reason}). Sie bleiben hier.',
  },
  'kept.refusedRemote': {
    one: 'Der Server lehnt {count} Eintrag ab ({reason}). Er bleibt auf diesem Gerät, und Sie können weitermachen. {contact}',
    other:
      'Der Server lehnt {count} Einträge ab ({reason}). Sie bleiben auf diesem Gerät, und Sie können weitermachen. {contact}',
  },

  'end.title': 'Vielen Dank',
  'end.stopped': 'Ihre Teilnahme ist beendet. Nehmen Sie das Headset ab und ruhen Sie sich aus.',
  'end.done': 'Sie haben alles geschafft.',
  'end.arrived': 'Alle Ihre Antworten sind angekommen. Sie können diese Seite schließen.',
  'end.keepOpen': 'Bitte lassen Sie diese Seite geöffnet, bis Ihre Antworten angekommen sind.',
  'end.withdraw': 'Mit Ihrem Löschcode können Sie alles löschen lassen: {address}',
  'lockedOut.title': 'Hier geht es nicht weiter',
  'lockedOut.released': 'Ihr Platz wurde für ein anderes Gerät freigegeben. Bitte nehmen Sie das Headset ab.',
  'lockedOut.deleted':
    'Ihr Platz wurde für ein anderes Gerät freigegeben oder gelöscht. Bitte nehmen Sie das Headset ab.',
  'lockedOut.silent': 'Dieses Gerät sendet nichts mehr.',
  'lockedOut.place':
    '{participant} wurde für ein anderes Gerät freigegeben, oder die Aufzeichnungen wurden gelöscht. Dieses Gerät sendet nichts mehr.',
  'lockedOut.contact': 'Haben Sie weder Ihre Daten gelöscht noch anderswo weitergemacht? {contact}',
  'lockedOut.unsent': {
    one: '{count} Eintrag wurde nie gesendet. Wenn Sie neu beginnen, wird er von diesem Gerät gelöscht.',
    other: '{count} Einträge wurden nie gesendet. Wenn Sie neu beginnen, werden sie von diesem Gerät gelöscht.',
  },
  'lockedOut.restart': 'Hier löschen und neu beginnen',

  'withdrawal.title': 'Teilnahme widerrufen',
  'withdrawal.study': 'Die Studie, wie sie in Ihrem Link steht',
  'withdrawal.code': 'Ihr Löschcode',
  'withdrawal.explained':
    'Alles, was in dieser Studie über Sie aufgezeichnet wurde, wird sofort gelöscht: Antworten, Ergebnisse, Bewegungen und wie weit Sie gekommen sind. Es bleibt nur ein Beleg, der festhält, wann wie viel gelöscht wurde. Sie müssen keinen Grund angeben. Das Löschen kann nicht rückgängig gemacht werden, und Ihr Platz wird Ihnen nicht noch einmal gegeben.',
  'withdrawal.sure': 'Ich möchte, dass alles gelöscht wird, was über mich aufgezeichnet wurde.',
  'withdrawal.delete': 'Alles löschen',
  'withdrawal.lookUp': 'Der Code wurde Ihnen nach Ihrer Einwilligung angezeigt; niemand kann ihn für Sie nachschlagen.',
  'withdrawal.contact': 'Funktioniert etwas nicht? {contact}',
  'withdrawal.unknownCode':
    'Unter diesem Code ist nichts gespeichert. Vergleichen Sie ihn mit Ihrer Notiz; haben Sie ihn schon einmal abgeschickt, ist bereits alles gelöscht.',
  'withdrawal.unheard':
    'Ob alles gelöscht ist, ist nicht bekannt. Schicken Sie den Code noch einmal ab; wurde gelöscht, ist unter ihm nichts mehr gespeichert. Technischer Grund (englisch): {reason}.',
  'withdrawal.failed':
    'Es wurde noch nichts gelöscht. Versuchen Sie es noch einmal, oder fragen Sie die Versuchsleitung. Technischer Grund (englisch): {reason}.',
  'receipt.name': 'Beleg',
  'receipt.title': 'Alles ist gelöscht',
  'receipt.number': 'Beleg {number} der Studie „{study}“',
  'receipt.deleted': 'Gelöscht von {participant}: {records}, {recordings}',
  'receipt.records': { one: '{count} Eintrag', other: '{count} Einträge' },
  'receipt.recordings': { one: '{count} Bewegungsaufzeichnung', other: '{count} Bewegungsaufzeichnungen' },
  'receipt.when': '{time}, mit dem Löschcode, bei {address}',
  'receipt.hereToo':
    'Auch was dieser Browser noch gespeichert hatte, ist gelöscht. Wenn Sie ein weiteres Gerät benutzt haben, öffnen Sie dort Ihren Link: Was dort noch liegt, können Sie dann löschen.',
  'receipt.elsewhere':
    'Wenn Sie auf einem anderen Gerät teilgenommen haben, öffnen Sie dort Ihren Link: Was dort noch liegt, können Sie dann löschen.',
  'receipt.copies':
    'Kopien, die vorher weitergegeben wurden, liegen nicht mehr auf diesem Server: Mit der Nummer dieses Belegs können Sie auch sie löschen lassen.',
  'receipt.save': 'Beleg speichern',
} satisfies Catalogue;
